// One lane: for processors without a kernel of their own.
#include "batch/kernel.h"

namespace bentaxis::analytic {

void run_batch_scalar(const BatchJob& job, std::size_t begin, std::size_t end) {
  run_batch<double>(job, begin, end);
}
void tally_batch_scalar(const BatchJob& job, const BatchTally& tally, std::size_t begin,
                        std::size_t end, Statistics* sums) {
  tally_batch<double>(job, tally, begin, end, sums);
}

}  // namespace bentaxis::analytic

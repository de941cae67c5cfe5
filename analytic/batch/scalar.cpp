// One lane: for processors without a kernel of their own.
#include "batch/kernel.h"

namespace bentaxis::analytic {

void run_batch_scalar(const BatchJob& job, std::size_t begin, std::size_t end) {
  run_batch<double>(job, begin, end);
}

}  // namespace bentaxis::analytic

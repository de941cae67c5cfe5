#define xsimd xsimd_sse2  // see kernel.h
#define BENTAXIS_SIMD_UNIT
#include "batch/kernel.h"

namespace bentaxis::analytic {

void run_batch_sse2(const BatchJob& job, std::size_t begin, std::size_t end) {
  run_batch<xsimd::batch<double, xsimd::sse2>>(job, begin, end);
}
void tally_batch_sse2(const BatchJob& job, const BatchTally& tally, std::size_t begin,
                      std::size_t end, Statistics* sums) {
  tally_batch<xsimd::batch<double, xsimd::sse2>>(job, tally, begin, end, sums);
}

}  // namespace bentaxis::analytic

#define xsimd xsimd_avx512  // see kernel.h
#define BENTAXIS_SIMD_UNIT
#include "batch/kernel.h"

namespace bentaxis::analytic {

void run_batch_avx512(const BatchJob& job, std::size_t begin, std::size_t end) {
  run_batch<xsimd::batch<double, xsimd::avx512bw>>(job, begin, end);
}
void tally_batch_avx512(const BatchJob& job, const BatchTally& tally, std::size_t begin,
                        std::size_t end, Statistics* sums) {
  tally_batch<xsimd::batch<double, xsimd::avx512bw>>(job, tally, begin, end, sums);
}

}  // namespace bentaxis::analytic

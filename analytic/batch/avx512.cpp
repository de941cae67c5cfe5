#define xsimd xsimd_avx512  // see kernel.h
#define BENTAXIS_SIMD_UNIT
#include "batch/kernel.h"

namespace bentaxis::analytic {

void run_batch_avx512(const BatchJob& job, std::size_t begin, std::size_t end) {
  run_batch<xsimd::batch<double, xsimd::avx512bw>>(job, begin, end);
}

}  // namespace bentaxis::analytic

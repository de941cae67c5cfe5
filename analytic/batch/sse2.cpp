#define xsimd xsimd_sse2  // see kernel.h
#define BENTAXIS_SIMD_UNIT
#include "batch/kernel.h"

namespace bentaxis::analytic {

void run_batch_sse2(const BatchJob& job, std::size_t begin, std::size_t end) {
  run_batch<xsimd::batch<double, xsimd::sse2>>(job, begin, end);
}

}  // namespace bentaxis::analytic

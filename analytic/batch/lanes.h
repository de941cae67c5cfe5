// What the loop of a batch needs of a register of lanes: loading, storing, the functions of the
// algebra. Real is an xsimd vector or, on any processor, double itself: one lane.
#pragma once

#include <cmath>
#include <cstddef>
#ifdef BENTAXIS_SIMD_UNIT
#include <immintrin.h>

#include <xsimd/xsimd.hpp>
#endif

#include "batch/job.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic {

template <class Real>
struct Register;

/// One lane. Writing past the caches is left to the vectors.
template <>
struct Register<double> {
  static constexpr std::size_t kLanes = 1;
  static constexpr bool kStreams = false;
  BENTAXIS_INLINE static double load(const double* from) { return *from; }
  BENTAXIS_INLINE static void store(double value, double* to) { *to = value; }
  BENTAXIS_INLINE static void sine_cosine(double angle, double& sine, double& cosine) {
    sine = std::sin(angle);
    cosine = std::cos(angle);
  }
  BENTAXIS_INLINE static double least(double a, double b) { return b < a ? b : a; }
  BENTAXIS_INLINE static double largest(double a, double b) { return a < b ? b : a; }
};

#ifdef BENTAXIS_SIMD_UNIT

template <class A>
struct Register<xsimd::batch<double, A>> {
  using Real = xsimd::batch<double, A>;
  static constexpr std::size_t kLanes = Real::size;
  static constexpr bool kStreams = true;
  BENTAXIS_INLINE static Real load(const double* from) { return Real::load_unaligned(from); }
  BENTAXIS_INLINE static void store(const Real& value, double* to) { value.store_unaligned(to); }
  BENTAXIS_INLINE static void sine_cosine(const Real& angle, Real& sine, Real& cosine) {
    const auto both = xsimd::sincos(angle);
    sine = both.first;
    cosine = both.second;
  }
  BENTAXIS_INLINE static Real least(const Real& a, const Real& b) { return xsimd::min(a, b); }
  BENTAXIS_INLINE static Real largest(const Real& a, const Real& b) { return xsimd::max(a, b); }
  /// Past the caches; `to` is aligned to the register.
  BENTAXIS_INLINE static void stream(const Real& value, double* to) {
    if constexpr (kLanes == 2) _mm_stream_pd(to, value);
#ifdef __AVX__
    if constexpr (kLanes == 4) _mm256_stream_pd(to, value);
#endif
#ifdef __AVX512F__
    if constexpr (kLanes == 8) _mm512_stream_pd(to, value);
#endif
  }
  /// Stores past the caches made before it are seen by whoever is told of them after it.
  BENTAXIS_INLINE static void stream_done() { _mm_sfence(); }
};

#endif

}  // namespace bentaxis::analytic

#ifdef BENTAXIS_SIMD_UNIT

namespace bentaxis::analytic::closed_form {

template <class A>
struct Math<xsimd::batch<double, A>> {
  using Real = xsimd::batch<double, A>;
  BENTAXIS_INLINE static Real root(const Real& x) { return xsimd::sqrt(x); }
  BENTAXIS_INLINE static Real magnitude(const Real& x) { return xsimd::abs(x); }
  BENTAXIS_INLINE static Real tangent(const Real& x) {
    // Beyond 19.1 tanh rounds to 1: nearly everywhere, for a piston that is not at a dead centre.
    if (xsimd::all(xsimd::abs(x) > Real(20.0))) return direction(x);
    return xsimd::tanh(x);
  }
  BENTAXIS_INLINE static Real direction(const Real& x) {
    return xsimd::select(x < Real(0.0), Real(-1.0), Real(1.0));
  }
  BENTAXIS_INLINE static Real sign(const Real& x, const Real& rest) {
    return xsimd::select(xsimd::abs(x) <= rest, Real(0.0), direction(x));
  }
};

}  // namespace bentaxis::analytic::closed_form

#endif

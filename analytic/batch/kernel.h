// The loop of a batch, for one instruction set. Internal: included by one translation unit per
// instruction set. None of them may define a function that the linker could take for another's:
// run on an older processor, that would be an illegal instruction. xsimd has such functions (of
// plain doubles, for reducing angles), so each unit gives its namespace a name of its own. A test
// looks at the symbols.
#pragma once

#include <cstddef>
#include <cstring>
#include <xsimd/xsimd.hpp>

#include "batch/job.h"
#include "closed_form/reactions.h"

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

namespace bentaxis::analytic {

// Stores a whole register past the caches; here because a line is written at once only where a
// register is as long as a line.
template <class A>
BENTAXIS_INLINE void stream(const xsimd::batch<double, A>& value, double* to) {
#ifdef __AVX512F__
  _mm512_stream_pd(to, value);
#else
  value.store_unaligned(to);
#endif
}

template <class Real>
struct Lanes {
  static constexpr std::size_t kLanes = Real::size;

  BENTAXIS_INLINE static Real load(const double* from, std::size_t used) {
    if (used == kLanes) return Real::load_unaligned(from);
    double padded[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) padded[i] = from[i < used ? i : 0];
    return Real::load_unaligned(padded);
  }
  BENTAXIS_INLINE static Real load(const BatchJob::Column& column, std::size_t at,
                                   std::size_t used) {
    return column.each == nullptr ? Real(column.all) : load(column.each + at, used);
  }
  template <bool kStream>
  BENTAXIS_INLINE static void store(const Real& value, double* to, std::size_t used) {
    if (used == kLanes) {
      if constexpr (kStream)
        stream(value, to);
      else
        value.store_unaligned(to);
      return;
    }
    double padded[kLanes];
    value.store_unaligned(padded);
    for (std::size_t i = 0; i < used; ++i) to[i] = padded[i];
  }
};

// `used` lanes from instant `at` on.
template <class Real, bool kStream, class Par>
BENTAXIS_INLINE void evaluate_lanes(const BatchJob& job, const closed_form::Pump<Par>& pump,
                                    std::size_t at, std::size_t used) {
  using L = Lanes<Real>;
  closed_form::State<Real> state;
  const auto angle = xsimd::sincos(L::load(job.theta, at, used));
  state.sine = angle.first;
  state.cosine = angle.second;
  state.omega = L::load(job.omega, at, used);
  state.omega_dot = L::load(job.omega_dot, at, used);
  state.suction = L::load(job.suction, at, used);
  state.delivery = L::load(job.delivery, at, used);
  closed_form::reactions(
      job.common, pump, state, job.bodies,
      [&](int k) { return L::load(job.chamber_pressure[k], at, used); },
      [&](int index, const Real& value) {
        double* const column = job.outputs[index];
        if (column != nullptr) L::template store<kStream>(value, column + at, used);
      });
}

// Numbers of the pumps in the lanes: Pump<Real> is an array of Real with names.
template <class Real>
BENTAXIS_INLINE closed_form::Pump<Real> load_pumps(const BatchJob& job, std::size_t at,
                                                   std::size_t used) {
  constexpr std::size_t kNumbers = sizeof(closed_form::Pump<double>) / sizeof(double);
  static_assert(sizeof(closed_form::Pump<Real>) == kNumbers * sizeof(Real));
  closed_form::Pump<Real> pump;
  Real all[kNumbers];
  for (std::size_t i = 0; i < kNumbers; ++i)
    all[i] = Lanes<Real>::load(job.pumps + i * job.pumps_stride + at, used);
  std::memcpy(&pump, all, sizeof pump);
  return pump;
}

template <class Real, bool kStream>
void run_lanes(const BatchJob& job, std::size_t begin, std::size_t end) {
  constexpr std::size_t kWidth = Real::size;
  std::size_t at = begin;
  if (job.pumps == nullptr) {
    const closed_form::Pump<double> pump = *job.pump;  // a copy: results cannot overlap it
    for (; at + kWidth <= end; at += kWidth) evaluate_lanes<Real, kStream>(job, pump, at, kWidth);
    if (at < end) evaluate_lanes<Real, kStream>(job, pump, at, end - at);
    return;
  }
  for (; at < end; at += kWidth) {
    const std::size_t used = end - at < kWidth ? end - at : kWidth;
    evaluate_lanes<Real, kStream>(job, load_pumps<Real>(job, at, used), at, used);
  }
}

template <class A>
void run_batch(const BatchJob& job, std::size_t begin, std::size_t end) {
  using Real = xsimd::batch<double, A>;
#ifdef __AVX512F__
  if (job.stream) {
    run_lanes<Real, true>(job, begin, end);
    _mm_sfence();
    return;
  }
#endif
  run_lanes<Real, false>(job, begin, end);
}

}  // namespace bentaxis::analytic

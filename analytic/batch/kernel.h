// The loop of a batch, for one instruction set: included by one translation unit per instruction
// set. None of them may define a function that the linker could take for another's: run on an older
// processor, that would be an illegal instruction. Everything here is therefore local to the unit,
// and xsimd, which has such functions (of plain doubles, for reducing angles), gets a name of its
// own in each. A test looks at the symbols.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "batch/job.h"
#include "batch/lanes.h"
#include "closed_form/reactions.h"

namespace bentaxis::analytic {

constexpr std::size_t kDoublesPerLine = 64 / sizeof(double);
constexpr std::size_t kMostReactions = 5 * kMostPistons + 12;
template <template <class> class Turning>
inline constexpr bool kFree = std::is_same_v<Turning<double>, closed_form::FreeState<double>>;

template <class Real>
struct Lanes {
  static constexpr std::size_t kLanes = Register<Real>::kLanes;

  BENTAXIS_INLINE static Real load(const double* from, std::size_t used) {
    if (used == kLanes) return Register<Real>::load(from);
    double padded[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) padded[i] = from[i < used ? i : 0];
    return Register<Real>::load(padded);
  }
  BENTAXIS_INLINE static Real load(const BatchJob::Column& column, std::size_t at,
                                   std::size_t used) {
    return column.each == nullptr ? Real(column.all) : load(column.each + at, used);
  }
  BENTAXIS_INLINE static void store(const Real& value, double* to, std::size_t used) {
    if (used == kLanes) {
      Register<Real>::store(value, to);
      return;
    }
    double padded[kLanes];
    Register<Real>::store(value, padded);
    for (std::size_t i = 0; i < used; ++i) to[i] = padded[i];
  }
};

// `used` lanes from instant `at` on; results to put(column, value). Turning: State of one lane, or
// FreeState where the block moves on its own.
template <class Real, template <class> class Turning, class Par, class Put>
BENTAXIS_INLINE void evaluate_lanes(const BatchJob& job, const closed_form::Pump<Par>& pump,
                                    std::size_t at, std::size_t used, const Put& put) {
  using L = Lanes<Real>;
  Turning<Real> state;
  Register<Real>::sine_cosine(L::load(job.theta, at, used), state.sine, state.cosine);
  state.omega = L::load(job.omega, at, used);
  state.omega_dot = L::load(job.omega_dot, at, used);
  state.suction = L::load(job.suction, at, used);
  state.delivery = L::load(job.delivery, at, used);
  if constexpr (kFree<Turning>) {
    Real half_sine, half_cosine;
    Register<Real>::sine_cosine((L::load(job.psi, at, used) - L::load(job.theta, at, used)) * 0.5,
                                half_sine, half_cosine);
    state.lead(half_sine, half_cosine);
    state.block_omega = L::load(job.block_omega, at, used);
    state.block_omega_dot = L::load(job.block_omega_dot, at, used);
  }
  closed_form::reactions<Real>(
      job.common, pump, state, job.bodies,
      [&](int k) { return L::load(job.chamber_pressure[k], at, used); }, put);
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

// Results to their columns by ordinary stores.
template <class Real>
struct Store {
  const BatchJob& job;
  std::size_t at, used;
  BENTAXIS_INLINE void operator()(int index, const Real& value) const {
    double* const column = job.outputs[index];
    if (column != nullptr) Lanes<Real>::store(value, column + at, used);
  }
};

template <class Real, template <class> class Turning>
BENTAXIS_INLINE void store_lanes(const BatchJob& job, std::size_t at, std::size_t end) {
  constexpr std::size_t kLanes = Register<Real>::kLanes;
  if (job.pumps == nullptr) {
    const closed_form::Pump<double> pump = *job.pump;  // a copy: results cannot overlap it
    for (; at + kLanes <= end; at += kLanes)
      evaluate_lanes<Real, Turning>(job, pump, at, kLanes, Store<Real>{job, at, kLanes});
    if (at < end)
      evaluate_lanes<Real, Turning>(job, pump, at, end - at, Store<Real>{job, at, end - at});
    return;
  }
  for (; at < end; at += kLanes) {
    const std::size_t used = end - at < kLanes ? end - at : kLanes;
    evaluate_lanes<Real, Turning>(job, load_pumps<Real>(job, at, used), at, used,
                                  Store<Real>{job, at, used});
  }
}

// One register past the caches: right where it is as long as a line.
template <class Real>
struct Stream {
  const BatchJob& job;
  std::size_t at;
  BENTAXIS_INLINE void operator()(int index, const Real& value) const {
    double* const column = job.outputs[index];
    if (column != nullptr) Register<Real>::stream(value, column + at);
  }
};

// Collects the parts of a line, which must be written past the caches one right after the other.
template <class Real>
struct Collect {
  double (*lines)[kDoublesPerLine];
  std::size_t part;
  BENTAXIS_INLINE void operator()(int index, const Real& value) const {
    Register<Real>::store(value, lines[index] + part);
  }
};

// Instants from `at` on past the caches, as many whole lines as there are before `end`; where it
// ended.
template <class Real, template <class> class Turning>
BENTAXIS_INLINE std::size_t stream_lines(const BatchJob& job, std::size_t at, std::size_t end) {
  constexpr std::size_t kLanes = Register<Real>::kLanes;
  const auto pump_at = [&](std::size_t first) { return load_pumps<Real>(job, first, kLanes); };
  const closed_form::Pump<double> one =
      job.pumps == nullptr ? *job.pump : closed_form::Pump<double>{};
  if constexpr (kLanes == kDoublesPerLine) {
    for (; at + kLanes <= end; at += kLanes) {
      if (job.pumps == nullptr)
        evaluate_lanes<Real, Turning>(job, one, at, kLanes, Stream<Real>{job, at});
      else
        evaluate_lanes<Real, Turning>(job, pump_at(at), at, kLanes, Stream<Real>{job, at});
    }
  } else {
    const int reactions = kReactionsEnd.per_piston * job.common.pistons + kReactionsEnd.single;
    const int absent =
        job.common.imposed ? closed_form::column<Quantity::Rcs>(job.common.pistons, 0, 0) : -1;
    alignas(64) double lines[kMostReactions][kDoublesPerLine];
    for (; at + kDoublesPerLine <= end; at += kDoublesPerLine) {
      for (std::size_t part = 0; part < kDoublesPerLine; part += kLanes) {
        const Collect<Real> collect = {lines, part};
        if (job.pumps == nullptr)
          evaluate_lanes<Real, Turning>(job, one, at + part, kLanes, collect);
        else
          evaluate_lanes<Real, Turning>(job, pump_at(at + part), at + part, kLanes, collect);
      }
      for (int c = 0; c < reactions; ++c) {
        double* const column = job.outputs[c];
        if (column == nullptr || c == absent) continue;
        for (std::size_t part = 0; part < kDoublesPerLine; part += kLanes)
          Register<Real>::stream(Register<Real>::load(lines[c] + part), column + at + part);
      }
    }
  }
  return at;
}

// Apart from each other: what one kind of motion needs costs the other no register.
template <class Real, template <class> class Turning>
[[gnu::noinline]] void run_turning(const BatchJob& job, std::size_t begin, std::size_t end) {
  if constexpr (Register<Real>::kStreams) {
    if (job.stream) {
      begin = stream_lines<Real, Turning>(job, begin, end);
      Register<Real>::stream_done();
    }
  }
  store_lanes<Real, Turning>(job, begin, end);
}

template <class Real>
void run_batch(const BatchJob& job, std::size_t begin, std::size_t end) {
  if (job.free)
    run_turning<Real, closed_form::FreeState>(job, begin, end);
  else
    run_turning<Real, closed_form::State>(job, begin, end);
}

}  // namespace bentaxis::analytic

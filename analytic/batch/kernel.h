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
constexpr std::size_t kMaxReactions = 5 * kMaxPistons + 12;
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
// FreeState where the block moves on its own, JointState, CardanState or DoubleCardanState where a
// joint turns it.
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
  closed_form::turn_block(pump.joint, state);
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

// Collects results of some instants in one line per reaction: what must be written past the caches
// one right after the other, or is added up.
template <class Real, std::size_t kLength>
struct Collect {
  double (*lines)[kLength];
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
    const int absent = job.common.imposed || job.common.transfer != TransferKind::gear
                           ? closed_form::column<Quantity::Rcs>(job.common.pistons, 0, 0)
                           : -1;
    alignas(64) double lines[kMaxReactions][kDoublesPerLine];
    for (; at + kDoublesPerLine <= end; at += kDoublesPerLine) {
      for (std::size_t part = 0; part < kDoublesPerLine; part += kLanes) {
        const Collect<Real, kDoublesPerLine> collect = {lines, part};
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
  switch (job.block) {
    case BatchJob::Block::free:
      return run_turning<Real, closed_form::FreeState>(job, begin, end);
    case BatchJob::Block::joint:
      return run_turning<Real, closed_form::JointState>(job, begin, end);
    case BatchJob::Block::cardan:
      return run_turning<Real, closed_form::CardanState>(job, begin, end);
    case BatchJob::Block::double_cardan:
      return run_turning<Real, closed_form::DoubleCardanState>(job, begin, end);
    case BatchJob::Block::locked:
      return run_turning<Real, closed_form::State>(job, begin, end);
  }
}

// Sums and extremes, lane by lane.
template <class Real>
struct Tally {
  using R = Register<Real>;
  static constexpr std::size_t kLanes = R::kLanes;
  Real sum, squares, low, high;

  BENTAXIS_INLINE static Tally load(const double* from) {
    return {R::load(from), R::load(from + kLanes), R::load(from + 2 * kLanes),
            R::load(from + 3 * kLanes)};
  }
  BENTAXIS_INLINE void store(double* to) const {
    R::store(sum, to);
    R::store(squares, to + kLanes);
    R::store(low, to + 2 * kLanes);
    R::store(high, to + 3 * kLanes);
  }
  BENTAXIS_INLINE void add(const Real& value) { add(value, value); }
  // `summed`: the value, 0 in lanes that are not used.
  BENTAXIS_INLINE void add(const Real& value, const Real& summed) {
    sum = sum + summed;
    squares = squares + summed * summed;
    low = R::least(low, value);
    high = R::largest(high, value);
  }
};

// What is measured, of the instants of a block from `part` on.
template <class Real>
BENTAXIS_INLINE Real measured_value(const Measured& m, const double (*block)[kBlock],
                                    std::size_t part) {
  const Real first = Register<Real>::load(block[m.reaction] + part);
  if (m.components == 1) return first;
  Real squares = first * first;
  for (std::size_t c = 1; c < m.components; ++c) {
    const Real next = Register<Real>::load(block[m.reaction + c] + part);
    squares = squares + next * next;
  }
  return closed_form::Math<Real>::root(squares);
}

// Adds the first `used` instants of a block to the lanes.
template <class Real>
BENTAXIS_INLINE void tally_block(const BatchTally& tally, std::size_t used) {
  constexpr std::size_t kLanes = Register<Real>::kLanes;
  for (std::size_t i = 0; i < tally.measured.size(); ++i) {
    double* const lanes = tally.lanes + i * kTallied * kMaxLanes;
    const Measured m = tally.measured[i];
    auto all = Tally<Real>::load(lanes);
    std::size_t part = 0;
    for (; part + kLanes <= used; part += kLanes)
      all.add(measured_value<Real>(m, tally.block, part));
    if (part < used) {  // lanes beyond are copies of the first
      const Real value = measured_value<Real>(m, tally.block, part);
      double summed[kLanes];
      Register<Real>::store(value, summed);
      for (std::size_t lane = used - part; lane < kLanes; ++lane) summed[lane] = 0;
      all.add(value, Register<Real>::load(summed));
    }
    all.store(lanes);
  }
}

template <class Real, template <class> class Turning>
[[gnu::noinline]] void tally_turning(const BatchJob& job, const BatchTally& tally,
                                     std::size_t begin, std::size_t end) {
  constexpr std::size_t kLanes = Register<Real>::kLanes;
  static_assert(kBlock % kLanes == 0 && kLanes <= kMaxLanes);
  const closed_form::Pump<double> pump = *job.pump;  // a copy: results cannot overlap it
  for (std::size_t at = begin; at < end; at += kBlock) {
    const std::size_t used = end - at < kBlock ? end - at : kBlock;
    std::size_t part = 0;
    for (; part + kLanes <= used; part += kLanes)
      evaluate_lanes<Real, Turning>(job, pump, at + part, kLanes,
                                    Collect<Real, kBlock>{tally.block, part});
    if (part < used)
      evaluate_lanes<Real, Turning>(job, pump, at + part, used - part,
                                    Collect<Real, kBlock>{tally.block, part});
    tally_block<Real>(tally, used);
  }
}

template <class Real>
void tally_batch(const BatchJob& job, const BatchTally& tally, std::size_t begin, std::size_t end,
                 Statistics* sums) {
  constexpr std::size_t kLanes = Register<Real>::kLanes;
  constexpr double kNothing = __builtin_huge_val();
  const Tally<Real> none = {Real(0.0), Real(0.0), Real(kNothing), Real(-kNothing)};
  for (std::size_t i = 0; i < tally.measured.size(); ++i)
    none.store(tally.lanes + i * kTallied * kMaxLanes);
  switch (job.block) {
    case BatchJob::Block::free:
      tally_turning<Real, closed_form::FreeState>(job, tally, begin, end);
      break;
    case BatchJob::Block::joint:
      tally_turning<Real, closed_form::JointState>(job, tally, begin, end);
      break;
    case BatchJob::Block::cardan:
      tally_turning<Real, closed_form::CardanState>(job, tally, begin, end);
      break;
    case BatchJob::Block::double_cardan:
      tally_turning<Real, closed_form::DoubleCardanState>(job, tally, begin, end);
      break;
    case BatchJob::Block::locked:
      tally_turning<Real, closed_form::State>(job, tally, begin, end);
  }
  for (std::size_t i = 0; i < tally.measured.size(); ++i) {
    const double* const lanes = tally.lanes + i * kTallied * kMaxLanes;
    double sum = 0, squares = 0, low = kNothing, high = -kNothing;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sum += lanes[lane];
      squares += lanes[kLanes + lane];
      low = Register<double>::least(low, lanes[2 * kLanes + lane]);
      high = Register<double>::largest(high, lanes[3 * kLanes + lane]);
    }
    sums[i] = {sum, low, high, squares};
  }
}

}  // namespace bentaxis::analytic

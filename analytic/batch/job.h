// What a batch hands to the kernel of an instruction set: plain data only. Internal.
#pragma once

#include <cstddef>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/pump/parameters.h"
#include "closed_form/pump.h"

namespace bentaxis::analytic {

struct BatchJob {
  struct Column {
    const double* each;
    double all;
  };
  closed_form::Common common;
  bool stream;  // results do not fit in a cache: write them past it; outputs on cache lines then
  bool bodies;  // block and shaft asked for
  const closed_form::Pump<double>* pump;  // one for all lanes, or
  const double* pumps;                    // one array per number, pumps_stride apart
  std::size_t pumps_stride;
  Column theta, omega, omega_dot, suction, delivery;
  enum class Block { locked, free, joint, cardan, double_cardan } block;  // of a free one:
  Column psi, block_omega, block_omega_dot;
  const Column* chamber_pressure;
  double* const* outputs;
};

/// Evaluates instants [begin, end).
using BatchKernel = void(const BatchJob& job, std::size_t begin, std::size_t end);
BatchKernel run_batch_scalar, run_batch_sse2, run_batch_avx2, run_batch_avx512;

/// Instants whose results lie in the first-level cache until they are added up.
inline constexpr std::size_t kBlock = 64;
/// Lanes of the widest register.
inline constexpr std::size_t kMaxLanes = 8;
/// Numbers that are kept per lane of what is measured: sum, sum of squares, least, largest.
inline constexpr std::size_t kTallied = 4;

/// What statistics are made of, and room for that.
struct BatchTally {
  std::span<const Measured> measured;
  double (*block)[kBlock];  // one row per reaction
  double* lanes;            // kTallied x kMaxLanes per entry of `measured`
};

/// Adds up instants [begin, end) of the one pump of a job: the sum in `mean`, that of squares in
/// `mean_square`.
using TallyKernel = void(const BatchJob& job, const BatchTally& tally, std::size_t begin,
                         std::size_t end, Statistics* sums);
TallyKernel tally_batch_scalar, tally_batch_sse2, tally_batch_avx2, tally_batch_avx512;

}  // namespace bentaxis::analytic

// What a batch hands to the kernel of an instruction set: plain data only. Internal.
#pragma once

#include <cstddef>

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
  bool free;  // the block moves on its own:
  Column psi, block_omega, block_omega_dot;
  const Column* chamber_pressure;
  double* const* outputs;
};

/// Evaluates instants [begin, end).
using BatchKernel = void(const BatchJob& job, std::size_t begin, std::size_t end);
BatchKernel run_batch_scalar, run_batch_sse2, run_batch_avx2, run_batch_avx512;

}  // namespace bentaxis::analytic

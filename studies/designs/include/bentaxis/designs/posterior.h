// Draws from a density that residuals and bounds give: the sampler of identification. Knows no
// pump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bentaxis/designs/least_squares.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::designs {

/// Where an unknown goes in the sampler, so that what the data determine well is straight.
struct SamplerCoordinate {
  double (*inner)(double x);
  double (*outer)(double y);
  double (*stretch)(double x);  ///< logarithm of |dx/dy| at x, but for a constant
};
/// The unknown itself, and the logarithm of a positive one.
extern const SamplerCoordinate kOwnCoordinate, kLogarithmicCoordinate;

/// The density exp(-(sum of squared residuals) / 2) between the bounds, but for a constant.
struct SampledDensity {
  LeastSquaresProblem problem;                      ///< with bounds
  std::vector<SamplerCoordinate> coordinates = {};  ///< by unknown; empty: each is its own
  /// Logarithm of a further factor of unknown i alone; empty: none.
  std::function<double(std::size_t i, double x)> log_factor = {};
  /// By residual: whether it varies with errors of the data. That scatters the walkers' starts.
  /// Empty: all do.
  std::vector<char> noisy = {};
};

struct SamplerOptions {
  std::uint64_t seed = 1;
  std::size_t steps = 2000;  ///< of every walker; the second half is kept
  std::size_t draws = 400;   ///< that are returned, or as many as there are
  int threads = 0;
};

struct Draws {
  std::size_t count = 0;
  std::vector<double> unknowns;  ///< count x unknowns
  double accepted = 0;           ///< share of the moves
  double effective = 0;          ///< independent draws that they are worth, of the worst unknown
  std::vector<double> rhat;      ///< by unknown: two halves of the chain against each other
};

/// Two ensembles of walkers after Goodman & Weare (2010), half of whose moves are steps along the
/// difference of two others (ter Braak 2006).
/// @param fit  the minimum of the residuals: walkers start from fits to data with errors of their
///             own. The draws do not depend on the number of threads
Draws draws_of(const SampledDensity& density, const LeastSquaresFit& fit,
               const SamplerOptions& options, const Progress& progress = {});

}  // namespace bentaxis::designs

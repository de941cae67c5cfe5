// Sweeps: outputs of many designs, in blocks that can be computed anywhere and resumed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/designs/distribution.h"
#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/points.h"

namespace bentaxis::designs {

enum class Sampling {
  grid,             ///< every combination of levels, the last variable fastest
  latin_hypercube,  ///< of distributions
  sobol,
  random,
};
std::string to_string(Sampling sampling);

/// One variable of a sweep.
struct Varied {
  Variable variable;
  std::vector<double> levels;  ///< of a grid
  Distribution distribution;   ///< of the others
};

/// What is to be computed; all that results depend on but the case.
struct SweepPlan {
  Sampling sampling = Sampling::grid;
  std::vector<Varied> varied;
  std::size_t samples = 0;  ///< of all but a grid
  std::uint64_t seed = 1;   ///< likewise
  std::vector<Output> outputs;
  study::Model model = study::Model::analytic;
  double check_share = 0;  ///< of the designs, recomputed by the other model

  std::size_t size() const;  ///< number of designs
};

/// A design that the other model computed too.
struct SweepCheck {
  std::size_t design = 0;
  std::vector<double> values;  ///< one per output; not_computed() where it gives none
  std::string reason;          ///< why the other model has none
  std::vector<double> scales;  ///< of each output: what differences are over
  bool agrees = false;
};

/// Results in the order of the designs.
struct SweepResult {
  SweepPlan plan;
  Case base;
  std::size_t designs = 0;
  std::vector<double> values;   ///< designs x variables, row by row, files' units
  std::vector<double> results;  ///< designs x outputs, row by row
  /// Reasons of infeasible designs: by number of the design, rising.
  std::vector<std::pair<std::size_t, std::string>> infeasible;
  std::vector<SweepCheck> checks;
  double tolerance = 0;  ///< of the checks, of an output's scale
  double seconds = 0;
  bool agrees() const;
};

}  // namespace bentaxis::designs

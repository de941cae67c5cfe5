// Where a pressure that jumps has two values at one instant. Internal.
#pragma once

#include <cstddef>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::study {

/// Steps of a given pressure. Where a row of two runs falls on one, their integration errors decide
/// on which side of it each of them stands: then the difference of the row is that of the step.
class PressureSteps {
 public:
  PressureSteps() = default;  ///< none
  PressureSteps(const PressureSpec& spec, const PumpParameters& pump);

  /// Whether chambers of the two runs stand on different sides of a step in a row, and all others
  /// have the same pressure. A chamber does so where both block angles are within `angle_error`
  /// (rad) of the step and each run has the pressure of a side that it may stand on.
  bool between(const Trajectory& first, const Trajectory& second, std::size_t row,
               double angle_error) const;

 private:
  struct Step {
    double angle_deg, before, after;  // of the chamber; bar
  };
  std::vector<Step> steps_;
  std::vector<std::size_t> columns_;  // of the chambers' pressures
};

}  // namespace bentaxis::study

// What is applied to a pump, as a measure for reactions that vanish.
#pragma once

#include "bentaxis/pump/case.h"
#include "bentaxis/results/samples.h"

namespace bentaxis {

/// Largest applied load of a case, for channels whose peak is zero.
struct LoadScale {
  double force = 0;   ///< N: largest applied force
  double moment = 0;  ///< Nm: the same times the larger circle radius, or a friction torque
};
LoadScale load_scale(const Case& the_case, const Samples& samples);

}  // namespace bentaxis

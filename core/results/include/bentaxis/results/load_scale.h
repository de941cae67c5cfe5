// What is applied to a pump, as a measure for reactions that vanish.
#pragma once

#include "bentaxis/pump/case.h"
#include "bentaxis/results/samples.h"

namespace bentaxis {

/// Largest applied load of a case: scales of reactions have a floor from it.
struct LoadScale {
  double force = 0;  ///< N: largest applied force: pressure on a bore, a bottom area or half of the
                     ///< port plate, spring, friction of a piston, inertia of one, weight of a body
  double moment = 0;  ///< Nm: the same times the larger circle radius, or a friction torque
};
LoadScale load_scale(const Case& the_case, const Samples& samples);

}  // namespace bentaxis

// A pressure over the chamber's angle in the place of oil that follows the motion.
#pragma once

#include <memory>

#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/oil.h"

namespace bentaxis::coupled {

/// Oil without states: each chamber has the pressure of a trace at its own angle, whatever the
/// speed.
/// @param pressure  outlives it
std::unique_ptr<Oil> prescribed_oil(int pistons, const PressureTrace& pressure,
                                    const PortPressures& ports);

}  // namespace bentaxis::coupled

// Numbers of a periodic state that need its whole curve. Internal.
#pragma once

#include "bentaxis/hydraulics/steady_state.h"
#include "chamber.h"

namespace bentaxis::hydraulics {

/// J per turn of a chamber: area of its p-V diagram, the integral of -p dV, of the curve.
double indicated_work(const Chamber& chamber, const ComputedPressure& curve);
/// Pa: the largest difference of a spline through points of a curve from the curve.
double largest_of_spline(const PressureCurve& points, const ComputedPressure& curve);

}  // namespace bentaxis::hydraulics

// What compliant teeth do to each other.
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// Force of one flank on the other, N: Hunt and Crossley's law. It begins at 0, grows with the
/// approach and never pulls.
/// @param approach  how far the flanks are pressed into each other along the line of action, m;
///                  below 0: the gap between them
/// @param rate      of the approach, m/s
double flank_force(const ToothCompliance& teeth, double approach, double rate);

/// Force of a tooth between two flanks, N, signed towards +psi: the shaft's tooth lies in a gap
/// that is wider than it is by the backlash.
/// @param advance  of the shaft's pitch circle before the block's along the line of action that
///                 pushes the block towards +psi, m, from the middle of the gap
/// @param rate     of the advance, m/s
double tooth_force(const ToothCompliance& teeth, double advance, double rate);

}  // namespace bentaxis::multibody

// Drive torque by cause, by virtual power.
#pragma once

#include "bentaxis/results/budget.h"
#include "placement/placement.h"
#include "reactions/reactions.h"

namespace bentaxis::multibody {

/// The budget at the last placement. The pump moves in two ways that its bores allow: the shaft
/// turns and the block stands, and the other way round. What a load does along either, by the
/// velocities that Simbody's Jacobian gives the bodies, is its torque about that axis: no reaction
/// and no multiplier enters. Inertia is Simbody's residual of the accelerations without loads.
/// @param reactions  found there, whose torques and film force the parts must add up to
Budget budget_of(PumpSystem& pump, Placement& placement, const Reactions& reactions);

}  // namespace bentaxis::multibody

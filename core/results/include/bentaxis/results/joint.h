// How a joint turns the block: what given states are held to and completed by.
#pragma once

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"

namespace bentaxis {

/// Motion of the block where the shaft moves so, of a pump whose transfer is a joint: as the shaft,
/// or by the arms of a universal joint (docs/transfer.md).
AxisMotion joint_motion(const PumpParameters& pump, const AxisMotion& shaft);

}  // namespace bentaxis

// The cylinder block on its axis z2: pin and port plate together.
#pragma once

#include <SimTKsimbody.h>

#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// S2 in Ground: the axes of the block's bearing, tilted towards +y1, and its origin O2.
SimTK::Transform block_frame(const Geometry& geometry);

/// The block, turning about z2 in the given frame.
SimTK::MobilizedBody::Pin block_on_pin(SimTK::SimbodyMatterSubsystem& matter,
                                       const PumpParameters& pump, const SimTK::Transform& frame);

}  // namespace bentaxis::multibody

// The shaft in its two bearings.
#pragma once

#include <SimTKsimbody.h>

#include "bentaxis/pump/parameters.h"
#include "conventions.h"

namespace bentaxis::multibody {

/// The shaft on a spherical joint at C1, the tapered bearing. Its frame is S1 turned by the angle.
SimTK::MobilizedBody::Ball shaft_on_tapered_bearing(SimTK::SimbodyMatterSubsystem& matter,
                                                    const PumpParameters& pump);

/// The cylindrical bearing: an inline joint that keeps the shaft's axis on z1 at C2.
InlineJoint cylindrical_bearing(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
                                const PumpParameters& pump);

}  // namespace bentaxis::multibody

// What the scenes are, in Simbody's terms.
#pragma once

#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/parameters.h"
#include "scene/drive.h"

namespace bentaxis::multibody {

/// What turns the shaft in a scene that is evaluated at instants.
Drive drive_of(Scene scene);

/// @throws InputError where the bores' forces act off B: no integration serves such a pump.
void refuse_ring_off_b(const PumpParameters& pump);

/// @throws InputError where the contact is that of bevel teeth: Simbody's own integrators do not
/// know when their flanks meet and part.
void refuse_teeth(const Case& the_case);

/// The pump that is built: the one-piston scene is the scene of a pump with one piston.
PumpParameters built_pump(const PumpParameters& pump, Scene scene);

}  // namespace bentaxis::multibody

// Simbody's time integrators as they are used here.
#pragma once

#include <SimTKsimbody.h>

#include <memory>

#include "bentaxis/multibody/integrated.h"

namespace bentaxis::multibody {

/// One that reports at its own steps, without interpolation, and holds constraints to a tenth of
/// its accuracy.
std::unique_ptr<SimTK::Integrator> make_integrator(const SimTK::MultibodySystem& system,
                                                   const IntegrationOptions& options);

}  // namespace bentaxis::multibody

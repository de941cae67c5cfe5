// Assumptions of a model as given on the command line.
#pragma once

#include <string>

#include "bentaxis/pump/parameters.h"

namespace bentaxis::study {

/// Applies KEY=VALUE (piston_friction=on|off, inertia=lumped|real|dynamically_equivalent,
/// gear=mesh|imposed).
/// @throws InputError
void apply_assumption(const std::string& text, const PumpParameters& pump,
                      Assumptions& assumptions);

}  // namespace bentaxis::study

// The page of documentation in a unit's archive. Internal.
#pragma once

#include <string>

#include "description.h"

namespace bentaxis::fmu {

/// HTML: what the FMU is, its inputs, parameters and outputs with their units.
std::string documentation_page(const Description& description, const UnitOptions& options);

}  // namespace bentaxis::fmu

// The page of documentation in a unit's archive. Internal.
#pragma once

#include <string>

#include "description.h"

namespace bentaxis::fmu {

/// HTML: what the FMU is, its inputs, parameters and outputs with their units.
/// @param needs  what it runs on, in words
std::string documentation_page(const Description& description, const UnitOptions& options,
                               const std::string& needs);

}  // namespace bentaxis::fmu

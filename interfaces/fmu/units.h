// Units of measure in the description of an FMU. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bentaxis/pump/unit_of_measure.h"

namespace bentaxis::fmu {

/// Name of the type of variables in that unit: "VolumeFlowRate_L_min".
std::string type_name(const UnitOfMeasure& unit);

/// The unit that case files and tables call `unit`: "Nm", "l/min", "per GPa".
/// @return null where it is none: "", "-"
/// @throws std::logic_error where it is unknown
const UnitOfMeasure* unit_definition(std::string_view unit);

/// The definitions that `units` need, each once, in the order of the first need.
std::vector<const UnitOfMeasure*> unit_definitions(const std::vector<std::string>& units);

}  // namespace bentaxis::fmu

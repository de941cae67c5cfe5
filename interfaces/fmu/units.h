// Units as the standard defines them: a name, exponents of the SI's base units, factor and offset.
// Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bentaxis::fmu {

struct UnitDefinition {
  std::string name = {};                          ///< in a description: "N.m", "L/min"
  std::string quantity = {};                      ///< "Torque"
  int kg = 0, m = 0, s = 0, kelvin = 0, rad = 0;  ///< exponents
  double factor = 1, offset = 0;                  ///< SI value = factor * value + offset
  /// What people read it in, where that is another unit: "rpm" of "rad/s".
  std::string display = {};
  double display_factor = 1;  ///< displayed value = factor * value
};

/// Name of the type of variables in that unit: "VolumeFlowRate_L_min".
std::string type_name(const UnitDefinition& unit);

/// The unit that case files and tables call `unit`: "Nm", "l/min", "per GPa".
/// @return null where it is none: "", "-"
/// @throws std::logic_error where it is unknown
const UnitDefinition* unit_definition(std::string_view unit);

/// The definitions that `units` need, each once, in the order of the first need.
std::vector<const UnitDefinition*> unit_definitions(const std::vector<std::string>& units);

}  // namespace bentaxis::fmu

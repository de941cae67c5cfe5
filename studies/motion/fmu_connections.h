// Which variable of a unit goes to which of the pump. Internal.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/results/surroundings.h"
#include "bentaxis/study/fmu_coupling.h"

namespace bentaxis::study {

/// What the pump tells and takes.
struct PumpSide {
  std::vector<std::string> columns, units;  ///< of its tables; "?": a unit that has no name here
  TakesFromOutside takes;                   ///< the shaft and its torque: always, by [drive] kind
};
PumpSide pump_side(const Case& the_case, bool oil_follows);

/// @param place  the unit's file, for messages
/// @throws InputError as UnitCoupling
std::vector<Connection> connect(const fmu::UnitDescription& unit, const PumpSide& pump,
                                const std::vector<std::string>& wanted, const std::string& place);

}  // namespace bentaxis::study

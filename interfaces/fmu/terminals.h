// Terminals: the connections of a unit. Internal.
#pragma once

#include <string>
#include <vector>

#include "runtime/variables.h"

namespace bentaxis::fmu {

/// The text of terminalsAndIcons/terminalsAndIcons.xml: shaft (speed w, torque tau), suction and
/// delivery (gauge pressure p, volume flow q at the density in the suction port), each where the
/// unit has both variables. Empty where there is no connection. FMI 2.0 has none.
std::string terminals_fmi3(const std::vector<Variable>& variables);

}  // namespace bentaxis::fmu

// The border: what a case file is refused for, a case made in memory is refused for too.
#pragma once

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/standard_registry.h"

namespace bentaxis {

/// Holds every parameter of a pump to its range and the parameters to each other, as the reader of
/// case files does. A closed bound may be left by a few units in the last place where the number
/// was converted, as 2 I_t by an I_a that was rounded on its own. Costs well below a microsecond.
/// @return the pump it was given
/// @throws InputError with one line: table, key, value in the file's unit, what is allowed.
const PumpParameters& validate(const PumpParameters& pump,
                               const Registry& registry = standard_registry());

/// The same for a whole case: how it runs, its pressure and its hydraulics too. Points of a
/// pressure curve are left to PressureTrace.
const Case& validate(const Case& the_case, const Registry& registry = standard_registry());

}  // namespace bentaxis

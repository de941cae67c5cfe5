// What holds the pressure on the delivery side.
#pragma once

#include "bentaxis/pump/case.h"

namespace bentaxis {

/// Whether the delivery side is held at a pressure: by an open line (delivery_bar = 0), or by a
/// load of constant pressure.
bool delivery_is_held(const Case& the_case);

}  // namespace bentaxis

// The parameters of this program, for whoever passes them on; what a registry is: registry.h.
#pragma once

namespace bentaxis {

struct Registry;

/// Every parameter that a case file of this program may have.
const Registry& standard_registry();

}  // namespace bentaxis

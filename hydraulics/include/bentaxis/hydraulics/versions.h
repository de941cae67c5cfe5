// Version of the library behind the time integration.
#pragma once

#include <string>

namespace bentaxis::hydraulics {

/// Of SUNDIALS, as linked: "6.4.1".
std::string sundials_version();

}  // namespace bentaxis::hydraulics

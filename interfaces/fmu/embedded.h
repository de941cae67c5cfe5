// Files that the program carries with it. Internal.
#pragma once

#include <string>

namespace bentaxis::fmu {

/// The shared library of an FMU, for Linux on x86-64.
std::string embedded_library();
/// The licence of this program, and what is joined to the library under which licence.
std::string embedded_licence();
std::string embedded_notices();

}  // namespace bentaxis::fmu

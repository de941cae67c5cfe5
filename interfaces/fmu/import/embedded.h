// The supervisor of the processes of FMUs (process/supervisor.cpp), which the library carries.
// Internal.
#pragma once

#include <string_view>

namespace bentaxis::fmu {

std::string_view embedded_supervisor();

}  // namespace bentaxis::fmu

// Messages of the program as Python's users should see them.
#pragma once

#include <string>

namespace bentaxis::python {

/// Options of the command line become names of arguments, and `--set pump.tilt_deg=95` becomes
/// `case["pump.tilt_deg"] = 95`.
std::string in_python(const std::string& message);

}  // namespace bentaxis::python

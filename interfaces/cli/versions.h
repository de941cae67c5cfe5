// What this program is built with and runs on.
#pragma once

#include <string>

#include "bentaxis/results/remarks.h"

namespace bentaxis::cli {

/// Name and version of program, compiler, libraries, processor; for reports.
Lines versions();
/// The same of what every program with these reports has. @param further  libraries of this one
Lines shared_versions(const Lines& further = {});

/// What the build has of them, in a line; "none" behind what it lacks.
std::string optional_parts();

}  // namespace bentaxis::cli

// What this program is built with and runs on.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bentaxis::cli {

/// Name and version of program, compiler, libraries, processor; for reports.
std::vector<std::pair<std::string, std::string>> versions();
/// The same without MPI, which the program alone is linked with, not who shares its reports.
std::vector<std::pair<std::string, std::string>> shared_versions();

/// What the build has of them, in a line; "none" behind what it lacks.
std::string optional_parts();

}  // namespace bentaxis::cli

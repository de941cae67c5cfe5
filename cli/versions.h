// What this program is built with and runs on.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bentaxis::cli {

/// Name and version of program, compiler, libraries, processor; for reports.
std::vector<std::pair<std::string, std::string>> versions();

}  // namespace bentaxis::cli

// Where the parts of the program are that are files of their own, loaded or started when they are
// wanted.
#pragma once

#include <filesystem>
#include <vector>

namespace bentaxis {

/// Beside the program or, in Python, beside the module, where that is installed; where the library
/// was installed or built. They need not exist.
std::vector<std::filesystem::path> module_folders();

}  // namespace bentaxis

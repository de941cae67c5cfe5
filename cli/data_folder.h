// Where the data that come with the program are.
#pragma once

#include <filesystem>

namespace bentaxis::cli {

/// The folder reference_data: of the installed copy the program belongs to, else of the source
/// tree it was built from.
/// @throws InputError where there is neither
std::filesystem::path reference_data();

}  // namespace bentaxis::cli

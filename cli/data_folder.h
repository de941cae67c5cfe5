// Where the data that come with the program are.
#pragma once

#include <filesystem>
#include <optional>

namespace bentaxis::cli {

/// The folder reference_data: of the installed copy the program belongs to, else of the source
/// tree it was built from; nothing where there is neither.
std::optional<std::filesystem::path> shipped_reference_data();

}  // namespace bentaxis::cli

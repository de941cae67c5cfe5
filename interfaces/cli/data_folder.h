// Where the data that come with the program are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace bentaxis::cli {

/// The folder reference_data: of the installed copy the program belongs to, else of the source
/// tree it was built from; nothing where there is neither.
std::optional<std::filesystem::path> shipped_reference_data();
/// The folder cases, likewise.
std::optional<std::filesystem::path> shipped_cases();
/// A page of the documentation, as a path where it is there: docs/NAME otherwise.
std::string document(const std::string& name);
/// The folder problems, likewise.
std::optional<std::filesystem::path> shipped_problems();
/// The same of a folder "reference_data", "cases" or "problems" and any file that was installed
/// with it.
/// @param data_from_file  path of the installed data from the folder that the file is in
std::optional<std::filesystem::path> shipped_folder(const std::string& name,
                                                    const std::filesystem::path& file,
                                                    const std::string& data_from_file);

}  // namespace bentaxis::cli

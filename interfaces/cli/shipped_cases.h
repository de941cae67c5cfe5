// Cases that come with the program, by name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bentaxis::cli {

/// A case that comes with the program, as its file describes it.
struct ShippedCase {
  std::string name;   ///< of the file, without its ending: "bap63_rated"
  std::string title;  ///< key `name` of the file
  std::string group;  ///< follows from its [pressure] and [drive]: "Constant speed, .."
  std::filesystem::path file;
};

/// The cases of a folder by group, within a group by name. @throws InputError for unreadable ones
std::vector<ShippedCase> cases_in(const std::filesystem::path& folder);

/// Names of the cases of a folder, which are not read. Empty where there is no folder.
std::vector<std::string> case_names(const std::optional<std::filesystem::path>& folder);

/// The file that the text of a CASE means: an existing file, else the shipped case of this name, or
/// that of a study. Text with a folder or an ending always means a file.
/// @param folder  of the shipped cases, where there is one
/// @throws InputError for a name that is neither, and for a missing cases/NAME.toml where there is
///         a shipped case of this name
std::string case_file(const std::string& text, const std::optional<std::filesystem::path>& folder);

/// "name: title" of each below the title of its group.
std::string cases_text(const std::vector<ShippedCase>& cases);
/// Array of objects with name, title, group and file.
std::string cases_json(const std::vector<ShippedCase>& cases);

}  // namespace bentaxis::cli

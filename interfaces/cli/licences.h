// Parts of other projects in the program, and their licences (LICENSES/parts.json).
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bentaxis::cli {

/// A library or script of another project.
struct Part {
  std::string name, version, spdx, purpose, how;
  std::vector<std::string> texts;  ///< names in licence_files()
  bool is_in_build = false;        ///< of optional parts: was it there when this was built?
};

/// Contents of LICENSES/, by file name. Made by scripts/cmake/embed.cmake.
const std::map<std::string, std::string>& licence_files();

/// All parts, in the order of the file.
std::vector<Part> parts();
/// A table of all parts: name, version, licence, purpose.
std::string parts_text();
/// The licence texts of a part; of "bentaxis" its own. @throws InputError for unknown names
std::string licence_text(const std::string& part);

}  // namespace bentaxis::cli

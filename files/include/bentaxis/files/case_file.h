// Cases read from case files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"

namespace bentaxis {

/// Reads and validates a case file (TOML, schema 1; docs/case_file.md).
/// @param changes  "TABLE.KEY=VALUE": read as if the file said so
/// @throws InputError with one line that names file, line, key, value and allowed range.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& changes = {});

/// The same for text already in memory; `file` is used in messages and to resolve a curve's path.
Case parse_case(const std::string& text, const std::filesystem::path& file);

}  // namespace bentaxis

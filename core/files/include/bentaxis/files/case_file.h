// Cases read from case files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/validate.h"

namespace bentaxis {

/// Reads and validates a case file (TOML, schema 1; docs/case_file.md).
/// @param changes   "TABLE.KEY=VALUE", VALUE as in TOML or a bare word for a text: read as if the
///                  file said so; of two for one key the last counts. Marked in Case::entries
/// @param registry  the tables and keys that a file may have
/// @throws InputError with one line that names file, line, key, value and allowed range; for a
///         change "--set TABLE.KEY=VALUE" stands for file and line.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& changes = {},
               const Registry& registry = standard_registry());

/// The same for text already in memory; `file` is used in messages and to resolve a curve's path.
Case parse_case(const std::string& text, const std::filesystem::path& file,
                const std::vector<std::string>& changes = {},
                const Registry& registry = standard_registry());

}  // namespace bentaxis

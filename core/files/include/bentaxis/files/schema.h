// The format of case files for editors and for readers of docs/, from the registry.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/validate.h"

namespace bentaxis {

/// JSON Schema (draft 7) of a case file, as editors with TOML support take it: types, ranges,
/// choices, defaults, meanings, and which keys a choice makes necessary. What parameters must be to
/// each other is left to the reader.
std::string case_schema(const Registry& registry = standard_registry());

/// The keys of a table as a Markdown table: key, symbol, meaning, range, default, and values met in
/// practice where there are any.
/// @param name  "pump"; "" for the top level. @throws InputError where there is none
std::string markdown_table(const std::string& name, const Registry& registry = standard_registry());

}  // namespace bentaxis

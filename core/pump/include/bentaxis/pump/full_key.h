// Names of parameters where nothing else says their table.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/registry.h"

namespace bentaxis {

/// "pump.tilt_deg"; in the table without a name the key alone.
inline std::string full_key(const Table& table, const Parameter& parameter) {
  return table.name.empty() ? parameter.key : table.name + "." + parameter.key;
}

/// Of a number its name, of a pair those of both, ".1" and ".2"; of anything else none.
inline std::vector<std::string> number_names(const Table& table, const Parameter& parameter) {
  const std::string name = full_key(table, parameter);
  if (std::holds_alternative<NumberField>(parameter.field)) return {name};
  if (std::holds_alternative<PairField>(parameter.field)) return {name + ".1", name + ".2"};
  return {};
}

}  // namespace bentaxis

#include "units.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "bentaxis/pump/lists.h"

namespace bentaxis::fmu {

std::string type_name(const UnitOfMeasure& unit) {
  std::string name = unit.quantity + "_" + (unit.standard == "%" ? unit.name : unit.standard);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

const UnitOfMeasure* unit_definition(std::string_view unit) {
  if (unit.empty() || unit == "-") return nullptr;
  const UnitOfMeasure* const found = find_unit_of_measure(unit);
  if (found == nullptr) throw std::logic_error("there is no unit of measure " + std::string(unit));
  return found;
}

std::vector<const UnitOfMeasure*> unit_definitions(const std::vector<std::string>& units) {
  std::vector<const UnitOfMeasure*> needed;
  for (const std::string& unit : units) {
    const UnitOfMeasure* definition = unit_definition(unit);
    if (definition != nullptr) add_once(needed, definition);
  }
  return needed;
}

}  // namespace bentaxis::fmu

#include "bentaxis/files/case_writer.h"

#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"

namespace bentaxis {
namespace {

// A TOML float: an integer would do for the reader, but a float stays one in other hands.
std::string toml_number(double value) {
  std::string text = number_text(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string toml_value(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return toml_number(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return toml_text(*text);
  if (const auto* pair = std::get_if<std::array<double, 2>>(&value))
    return "[" + toml_number((*pair)[0]) + ", " + toml_number((*pair)[1]) + "]";
  return to_text(value);
}

// What a file must say: nothing where the only allowed value is the default.
std::optional<Value> value_to_write(const Parameter& parameter, const Case& the_case) {
  auto value = value_of(parameter, the_case);
  if (!value && !parameter.fallback.value) value = static_cast<int>(parameter.range.low);
  return value;
}

std::string uncertainty_text(const UncertaintyData& data) {
  if (data.parameters.empty()) return "";
  std::string text = "\n[uncertainty]\n";
  for (const auto& [name, distribution] : data.parameters)
    text += toml_text(name) + " = " + toml_text(distribution) + "\n";
  const std::string pairs = joined(data.correlations, ", ", [](const auto& pair) {
    const auto& [first, second, coefficient] = pair;
    return "[" + toml_text(first) + ", " + toml_text(second) + ", " + toml_number(coefficient) +
           "]";
  });
  return pairs.empty() ? text : text + "correlation = [" + pairs + "]\n";
}

}  // namespace

std::string case_text(const Case& the_case, const Registry& registry) {
  std::string text;
  for (const Table& table : registry.tables) {
    if (table.part != nullptr && !table.part->exists(the_case)) continue;
    if (!table.name.empty()) text += "\n[" + table.name + "]\n";
    for (const Parameter& parameter : table.parameters) {
      if (!is_asked_for(parameter, registry, the_case)) continue;
      if (const auto value = value_to_write(parameter, the_case))
        text += parameter.key + " = " + toml_value(*value) + "\n";
    }
  }
  return text + uncertainty_text(the_case.uncertainty);
}

}  // namespace bentaxis

#include "bentaxis/pump/registry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/full_key.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/pump/words.h"

namespace bentaxis {
namespace {

// A converted number is off by half a unit in the last place, and so is the bound it is held to; a
// copy that was moved by one unit in the last place must pass too.
constexpr double kSlack = 8 * std::numeric_limits<double>::epsilon();

template <class... Lambdas>
struct Overloaded : Lambdas... {
  using Lambdas::operator()...;
};
template <class... Lambdas>
Overloaded(Lambdas...) -> Overloaded<Lambdas...>;

template <class T>
const T* read(const Access<T>& place, const Case& the_case) {
  return place.read == nullptr ? nullptr : place.read(the_case);
}

template <class T>
void write(const Access<T>& place, Case& the_case, const T& value) {
  if (place.write != nullptr) *place.write(the_case) = value;
}

double to_si(double value, const Unit& unit) {
  return unit.to_si == nullptr ? value : unit.to_si(value);
}

// The range of the SI value.
NumberRange si_range(const Parameter& parameter, const Case& the_case) {
  NumberRange range = range_of(parameter, the_case);
  if (parameter.unit.to_si == nullptr) return range;
  range.low = to_si(range.low, parameter.unit);
  range.high = to_si(range.high, parameter.unit);
  range.slack = kSlack;
  return range;
}

std::string integer_range_text(NumberRange range) {
  if (range.high == std::numeric_limits<int>::max())
    range.high = std::numeric_limits<double>::infinity();
  return range.text();
}

[[noreturn]] void refuse(const Table& table, const Parameter& parameter, const Case& the_case,
                         const std::string& why) {
  const auto value = value_of(parameter, the_case);
  throw InputError((table.name.empty() ? "" : "[" + table.name + "] ") + parameter.key +
                   (value ? " = " + to_text(*value) : "") + ": " + why);
}

void check(const Table& table, const Parameter& parameter, const Case& the_case) {
  if (!is_there(parameter, the_case)) return;
  const auto number = [&](const double* value) {
    if (value == nullptr || si_range(parameter, the_case).contains(*value)) return;
    const NumberRange range = range_of(parameter, the_case);
    refuse(table, parameter, the_case,
           "must be " + (std::isfinite(*value) ? range.text() : range.text_of("a finite number")));
  };
  for (const Access<double>* place : numbers_of(parameter.field)) number(read(*place, the_case));
  if (const auto* integer = std::get_if<IntegerField>(&parameter.field)) {
    const int* value = read(integer->place, the_case);
    if (value != nullptr && !parameter.range.contains(*value))
      refuse(table, parameter, the_case,
             "must be an integer " + integer_range_text(parameter.range));
  } else if (const auto* choice = std::get_if<ChoiceField>(&parameter.field)) {
    const std::size_t index = choice->read == nullptr ? 0 : choice->read(the_case);
    if (index >= parameter.words.size())
      throw InputError("[" + table.name + "] " + parameter.key + " = " + std::to_string(index) +
                       ": no such choice");
  }
}

void check_tables(const Case& the_case, const Registry& registry) {
  for (const Table& table : registry.tables) {
    if (table.part != nullptr && !table.part->exists(the_case)) {
      if (holds(table.part->needed, registry, the_case))
        throw InputError("table [" + table.name + "] is missing");
      continue;
    }
    for (const Parameter& parameter : table.parameters) check(table, parameter, the_case);
    for (const Rule& rule : table.rules)
      if (const std::string why = rule.broken(the_case); !why.empty())
        refuse(table, parameter_of(registry, table.name, rule.key), the_case, why);
  }
}

}  // namespace

FieldNumbers numbers_of(const Field& field) {
  if (const auto* number = std::get_if<NumberField>(&field)) return {{&number->place}, 1};
  if (const auto* pair = std::get_if<PairField>(&field)) return {{&pair->first, &pair->second}, 2};
  return {};
}

namespace {

// A key in small letters and without its unit: "Swash_Angle_deg" -> "swash_angle".
std::string without_unit(const std::string& written) {
  std::string key = lower_case(written);
  for (const char* const unit : {"_deg", "_rad", "_mm", "_m", "_bar", "_pa", "_mpa", "_rpm", "_kg"})
    if (key.ends_with(unit)) return key.substr(0, key.size() - std::string(unit).size());
  return key;
}

bool is_also(const Parameter& parameter, const std::string& key) {
  const std::string word = without_unit(key);
  return parameter.symbol == key || without_unit(parameter.key) == word ||
         contains(parameter.also, word);
}

}  // namespace

std::optional<std::string> meant_key(const Registry& registry, const std::string& table,
                                     const std::string& key) {
  // The table itself comes first, then the others in their order.
  for (const bool here : {true, false})
    for (const bool exactly : {true, false})
      for (const Table& one : registry.tables)
        for (const Parameter& parameter : one.parameters)
          if ((one.name == table) == here &&
              (exactly ? parameter.key == key : is_also(parameter, key)))
            return full_key(one, parameter);
  return std::nullopt;
}

std::string key_suggestion(const Registry& registry, const std::string& table,
                           const std::string& key) {
  if (const auto meant = meant_key(registry, table, key)) {
    const auto point = meant->rfind('.');
    const std::string its_table = point == std::string::npos ? "" : meant->substr(0, point);
    const std::string its_key = meant->substr(point + 1);  // npos + 1 is 0
    return "; did you mean " +
           (its_table.empty() || its_table == table ? "" : "[" + its_table + "] ") + "\"" +
           its_key + "\"?";
  }
  std::set<std::string> keys;
  for (const Table& one : registry.tables)
    if (one.name == table)
      for (const Parameter& parameter : one.parameters) keys.insert(parameter.key);
  return suggestion(key, keys);
}

const Table& table_of(const Registry& registry, const std::string& name) {
  for (const Table& table : registry.tables)
    if (table.name == name) return table;
  throw std::logic_error("no table [" + name + "] in the registry");
}

const Parameter& parameter_of(const Registry& registry, const std::string& table,
                              const std::string& key) {
  for (const Parameter& parameter : table_of(registry, table).parameters)
    if (parameter.key == key) return parameter;
  throw std::logic_error("no key " + key + " in [" + table + "] of the registry");
}

double in_file_unit(double si, const Unit& unit) {
  if (unit.to_si == nullptr || !std::isfinite(si)) return si;
  const double guess = si / unit.to_si(1);
  for (int digits = 15; digits <= 17; ++digits) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), guess,
                                   std::chars_format::scientific, digits - 1);
    double rounded = 0;
    std::from_chars(text.data(), end.ptr, rounded);
    if (unit.to_si(rounded) == si) return rounded;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  double up = guess;
  double down = guess;
  for (int i = 0; i < 4; ++i) {
    up = std::nextafter(up, infinity);
    down = std::nextafter(down, -infinity);
    for (const double near : {up, down})
      if (unit.to_si(near) == si) return near;
  }
  return guess;
}

std::optional<Value> value_of(const Parameter& parameter, const Case& the_case) {
  if (!is_there(parameter, the_case)) return std::nullopt;
  return std::visit(Overloaded{[&]<class T>(const PlainField<T>& field) -> std::optional<Value> {
                                 const T* value = read(field.place, the_case);
                                 if (value == nullptr) return std::nullopt;
                                 if constexpr (std::is_same_v<T, double>)
                                   return in_file_unit(*value, parameter.unit);
                                 else
                                   return *value;
                               },
                               [&](const ChoiceField& field) -> std::optional<Value> {
                                 if (field.read == nullptr) return std::nullopt;
                                 const std::size_t index = field.read(the_case);
                                 if (index >= parameter.words.size()) return std::nullopt;
                                 return parameter.words[index];
                               },
                               [&](const PairField& field) -> std::optional<Value> {
                                 const double* first = read(field.first, the_case);
                                 const double* second = read(field.second, the_case);
                                 if (first == nullptr || second == nullptr) return std::nullopt;
                                 return std::array{in_file_unit(*first, parameter.unit),
                                                   in_file_unit(*second, parameter.unit)};
                               },
                               [&](const CurveField& field) -> std::optional<Value> {
                                 const std::filesystem::path* file = read(field.file, the_case);
                                 if (file == nullptr) return std::nullopt;
                                 return file->empty() ? std::string()
                                                      : std::filesystem::absolute(*file).string();
                               }},
                    parameter.field);
}

void store(const Parameter& parameter, Case& the_case, const Value& value) {
  if (!is_there(parameter, the_case)) return;
  std::visit(
      Overloaded{[&]<class T>(const PlainField<T>& field) {
                   if constexpr (std::is_same_v<T, double>)
                     write(field.place, the_case, to_si(std::get<double>(value), parameter.unit));
                   else
                     write(field.place, the_case, std::get<T>(value));
                 },
                 [&](const ChoiceField& field) {
                   if (field.write == nullptr) return;
                   const auto& words = parameter.words;
                   const auto word =
                       std::find(words.begin(), words.end(), std::get<std::string>(value));
                   field.write(the_case, static_cast<std::size_t>(word - words.begin()));
                 },
                 [&](const PairField& field) {
                   const auto& pair = std::get<std::array<double, 2>>(value);
                   write(field.first, the_case, to_si(pair[0], parameter.unit));
                   write(field.second, the_case, to_si(pair[1], parameter.unit));
                 },
                 [&](const CurveField& field) {
                   write(field.file, the_case, std::filesystem::path(std::get<std::string>(value)));
                 }},
      parameter.field);
}

std::optional<Value> default_of(const Parameter& parameter, const Case& the_case) {
  if (parameter.fallback.computed != nullptr)
    return is_there(parameter, the_case) ? parameter.fallback.computed(the_case) : std::nullopt;
  return parameter.fallback.value;
}

NumberRange range_of(const Parameter& parameter, const Case& the_case) {
  if (parameter.range_here != nullptr && is_there(parameter, the_case))
    if (auto range = parameter.range_here(the_case)) {
      range->slack = parameter.unit.to_si == nullptr ? 0 : kSlack;
      return *range;
    }
  return parameter.range;
}

bool holds(const When& when, const Registry& registry, const Case& the_case) {
  if (when.words.empty()) return false;
  const auto value = value_of(parameter_of(registry, when.table, when.key), the_case);
  return value && contains(when.words, std::get<std::string>(*value));
}

bool is_active(const Table& table, const Parameter& parameter, const Registry& registry,
               const Case& the_case) {
  if (table.part != nullptr && !table.part->needed.words.empty() &&
      !holds(table.part->needed, registry, the_case))
    return false;
  return is_asked_for(parameter, registry, the_case);
}

bool is_asked_for(const Parameter& parameter, const Registry& registry, const Case& the_case) {
  if (!is_there(parameter, the_case)) return false;
  return parameter.active.words.empty() || holds(parameter.active, registry, the_case);
}

std::string to_text(const Value& value) {
  return std::visit(Overloaded{[](double number) { return number_text(number); },
                               [](int number) { return std::to_string(number); },
                               [](bool flag) { return std::string(flag ? "true" : "false"); },
                               [](const std::string& text) { return "\"" + text + "\""; },
                               [](const std::array<double, 2>& pair) {
                                 return "[" + number_text(pair[0]) + ", " + number_text(pair[1]) +
                                        "]";
                               }},
                    value);
}

std::string to_text(const When& when) {
  std::string words;
  for (const std::string& word : when.words)
    words += (words.empty() ? "\"" : " or \"") + word + "\"";
  return when.key + " = " + words;
}

// A pump alone is held to what holds for it in a case that says nothing else.
const PumpParameters& validate(const PumpParameters& pump, const Registry& registry) {
  Case the_case;
  the_case.pump = pump;
  check_tables(the_case, registry);
  return pump;
}

const Case& validate(const Case& the_case, const Registry& registry) {
  check_tables(the_case, registry);
  return the_case;
}

std::vector<PumpInput> continuous_inputs(PumpParameters& pump, const Registry& registry) {
  Case the_case;
  the_case.pump = pump;
  std::vector<PumpInput> always, in_parts;
  for (const Table& table : registry.tables)
    for (const Parameter& parameter : table.parameters) {
      if (parameter.path.empty() || !is_there(parameter, the_case)) continue;
      const Part* const part = parameter.within;
      const bool needed =
          part == nullptr || (part == table.part && holds(part->needed, registry, the_case));
      auto& list = needed ? always : in_parts;
      auto path = parameter.path.begin();
      for (const Access<double>* place : numbers_of(parameter.field))
        list.push_back({*path++, place->in_pump(pump), si_range(parameter, the_case)});
    }
  append(always, in_parts);
  return always;
}

}  // namespace bentaxis

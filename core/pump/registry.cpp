#include "bentaxis/pump/registry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/validate.h"

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
const T* read(const Access<T>& place, const ConstView& view) {
  return place.read == nullptr ? nullptr : place.read(view);
}

template <class T>
void write(const Access<T>& place, const View& view, const T& value) {
  if (place.write == nullptr) return;
  if (T* const field = place.write(view); field != nullptr) *field = value;
}

double to_si(double value, const Unit& unit) {
  return unit.to_si == nullptr ? value : unit.to_si(value);
}

const Part* part_of(const Table& table, const Parameter& parameter) {
  return parameter.part != nullptr ? parameter.part : table.part;
}

// The range of the SI value.
NumberRange si_range(const Parameter& parameter, const ConstView& view) {
  NumberRange range = range_of(parameter, view);
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

[[noreturn]] void refuse(const Table& table, const Parameter& parameter, const ConstView& view,
                         const std::string& why) {
  const auto value = value_of(parameter, view);
  throw InputError((table.name.empty() ? "" : "[" + table.name + "] ") + parameter.key +
                   (value ? " = " + to_text(*value) : "") + ": " + why);
}

void check(const Table& table, const Parameter& parameter, const ConstView& view) {
  const auto number = [&](const double* value) {
    if (value == nullptr || si_range(parameter, view).contains(*value)) return;
    const NumberRange range = range_of(parameter, view);
    refuse(table, parameter, view,
           "must be " + (std::isfinite(*value) ? range.text() : range.text_of("a finite number")));
  };
  if (const auto* field = std::get_if<NumberField>(&parameter.field)) {
    number(read(field->place, view));
  } else if (const auto* pair = std::get_if<PairField>(&parameter.field)) {
    number(read(pair->first, view));
    number(read(pair->second, view));
  } else if (const auto* integer = std::get_if<IntegerField>(&parameter.field)) {
    const int* value = read(integer->place, view);
    if (value != nullptr && !parameter.range.contains(*value))
      refuse(table, parameter, view, "must be an integer " + integer_range_text(parameter.range));
  } else if (const auto* choice = std::get_if<ChoiceField>(&parameter.field)) {
    const auto index = choice->read == nullptr ? std::nullopt : choice->read(view);
    if (index && *index >= parameter.words.size())
      throw InputError("[" + table.name + "] " + parameter.key + " = " + std::to_string(*index) +
                       ": no such choice");
  }
}

void validate(const ConstView& view, const Registry& registry) {
  for (const Table& table : registry.tables) {
    if (table.part != nullptr && !table.part->exists(view)) {
      if (holds(table.part->needed, registry, view))
        throw InputError("table [" + table.name + "] is missing");
      continue;
    }
    for (const Parameter& parameter : table.parameters) check(table, parameter, view);
    for (const Rule& rule : table.rules)
      if (const std::string why = rule.broken(view); !why.empty())
        refuse(table, parameter_of(registry, table.name, rule.key), view, why);
  }
}

}  // namespace

namespace {

template <class AnyView, class AnyCase>
AnyView whole_view(AnyCase& the_case) {
  AnyView view;
  view.pump = &the_case.pump;
  view.name = &the_case.name;
  view.ratings = &the_case.ratings;
  view.operation = &the_case.operation;
  view.pressure = &the_case.pressure;
  view.hydraulics = &the_case.hydraulics;
  view.drive = &the_case.drive;
  view.analytic = &the_case.analytic;
  view.multibody = &the_case.multibody;
  view.meant = &the_case.meant;
  return view;
}

}  // namespace

View view_of(PumpParameters& pump) {
  View view;
  view.pump = &pump;
  return view;
}

View view_of(Case& the_case) { return whole_view<View>(the_case); }

ConstView view_of(const PumpParameters& pump) {
  ConstView view;
  view.pump = &pump;
  return view;
}

ConstView view_of(const Case& the_case) { return whole_view<ConstView>(the_case); }

ConstView as_const(const View& v) {
  ConstView view;
  view.pump = v.pump;
  view.name = v.name;
  view.ratings = v.ratings;
  view.operation = v.operation;
  view.pressure = v.pressure;
  view.hydraulics = v.hydraulics;
  view.drive = v.drive;
  view.analytic = v.analytic;
  view.multibody = v.multibody;
  view.meant = v.meant;
  return view;
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

std::optional<Value> value_of(const Parameter& parameter, const ConstView& view) {
  const auto as_value = [](const auto* value) {
    return value == nullptr ? std::nullopt : std::optional<Value>(*value);
  };
  return std::visit(
      Overloaded{[&](const NumberField& field) -> std::optional<Value> {
                   const double* si = read(field.place, view);
                   if (si == nullptr) return std::nullopt;
                   return in_file_unit(*si, parameter.unit);
                 },
                 [&](const IntegerField& field) { return as_value(read(field.place, view)); },
                 [&](const FlagField& field) { return as_value(read(field.place, view)); },
                 [&](const TextField& field) { return as_value(read(field.place, view)); },
                 [&](const ChoiceField& field) -> std::optional<Value> {
                   const auto index = field.read == nullptr ? std::nullopt : field.read(view);
                   if (!index || *index >= parameter.words.size()) return std::nullopt;
                   return parameter.words[*index];
                 },
                 [&](const PairField& field) -> std::optional<Value> {
                   const double* first = read(field.first, view);
                   const double* second = read(field.second, view);
                   if (first == nullptr || second == nullptr) return std::nullopt;
                   return std::array{in_file_unit(*first, parameter.unit),
                                     in_file_unit(*second, parameter.unit)};
                 },
                 [&](const CurveField& field) -> std::optional<Value> {
                   const std::filesystem::path* file = read(field.file, view);
                   if (file == nullptr) return std::nullopt;
                   return file->empty() ? std::string() : std::filesystem::absolute(*file).string();
                 }},
      parameter.field);
}

void store(const Parameter& parameter, const View& view, const Value& value) {
  std::visit(
      Overloaded{
          [&](const NumberField& field) {
            write(field.place, view, to_si(std::get<double>(value), parameter.unit));
          },
          [&](const IntegerField& field) { write(field.place, view, std::get<int>(value)); },
          [&](const FlagField& field) { write(field.place, view, std::get<bool>(value)); },
          [&](const TextField& field) { write(field.place, view, std::get<std::string>(value)); },
          [&](const ChoiceField& field) {
            if (field.write == nullptr) return;
            const auto& words = parameter.words;
            const auto word = std::find(words.begin(), words.end(), std::get<std::string>(value));
            field.write(view, static_cast<std::size_t>(word - words.begin()));
          },
          [&](const PairField& field) {
            const auto& pair = std::get<std::array<double, 2>>(value);
            write(field.first, view, to_si(pair[0], parameter.unit));
            write(field.second, view, to_si(pair[1], parameter.unit));
          },
          [&](const CurveField& field) {
            write(field.file, view, std::filesystem::path(std::get<std::string>(value)));
          }},
      parameter.field);
}

std::optional<Value> default_of(const Parameter& parameter, const ConstView& view) {
  if (parameter.fallback.computed != nullptr) return parameter.fallback.computed(view);
  return parameter.fallback.value;
}

NumberRange range_of(const Parameter& parameter, const ConstView& view) {
  if (parameter.range_here != nullptr)
    if (auto range = parameter.range_here(view)) {
      range->slack = parameter.unit.to_si == nullptr ? 0 : kSlack;
      return *range;
    }
  return parameter.range;
}

bool holds(const When& when, const Registry& registry, const ConstView& view) {
  if (when.words.empty()) return false;
  const auto value = value_of(parameter_of(registry, when.table, when.key), view);
  return value && std::find(when.words.begin(), when.words.end(), std::get<std::string>(*value)) !=
                      when.words.end();
}

bool is_active(const Table& table, const Parameter& parameter, const Registry& registry,
               const ConstView& view) {
  const Part* const part = part_of(table, parameter);
  if (part != nullptr && !part->exists(view)) return false;
  return parameter.active.words.empty() || holds(parameter.active, registry, view);
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

const PumpParameters& validate(const PumpParameters& pump, const Registry& registry) {
  validate(view_of(pump), registry);
  return pump;
}

const Case& validate(const Case& the_case, const Registry& registry) {
  validate(view_of(the_case), registry);
  return the_case;
}

std::vector<PumpInput> continuous_inputs(PumpParameters& pump, const Registry& registry) {
  const View view = view_of(pump);
  std::vector<PumpInput> always, in_parts;
  for (const Table& table : registry.tables)
    for (const Parameter& parameter : table.parameters) {
      auto& list = part_of(table, parameter) == nullptr ? always : in_parts;
      const auto add = [&](const Access<double>& place, const std::string& path) {
        double* const value = place.write == nullptr ? nullptr : place.write(view);
        if (value != nullptr) list.push_back({path, value, si_range(parameter, as_const(view))});
      };
      if (const auto* number = std::get_if<NumberField>(&parameter.field)) {
        if (!parameter.path.empty()) add(number->place, parameter.path[0]);
      } else if (const auto* pair = std::get_if<PairField>(&parameter.field)) {
        if (parameter.path.size() == 2) {
          add(pair->first, parameter.path[0]);
          add(pair->second, parameter.path[1]);
        }
      }
    }
  always.insert(always.end(), in_parts.begin(), in_parts.end());
  return always;
}

}  // namespace bentaxis

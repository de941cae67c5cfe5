// One description of each parameter: where it stands in a case file, what it means, what it may be,
// and where it is kept. Reading, validation, writing, `--set`, the list that rounding and negative
// controls perturb, the JSON Schema and the tables of docs/ are made from it. A new parameter is
// one entry in tables/, a field, and the physics that uses it.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/plausible_range.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/pump/standard_registry.h"

namespace bentaxis {

/// Where a parameter is kept. Only to be asked for where its part is there (is_there()). Null
/// functions for what is only checked, as the schema's number.
template <class T>
struct Access {
  const T* (*read)(const Case&) = nullptr;
  T* (*write)(Case&) = nullptr;
  T* (*in_pump)(PumpParameters&) = nullptr;  ///< null where no pump has it
  std::string path = {};                     ///< there: "geometry.tilt"
};

// The types of parameters.
template <class T>
struct PlainField {
  Access<T> place;
};
using NumberField = PlainField<double>;
using IntegerField = PlainField<int>;
using FlagField = PlainField<bool>;
using TextField = PlainField<std::string>;
/// An enumeration, whose values are those of the words in their order.
struct ChoiceField {
  std::size_t (*read)(const Case&) = nullptr;
  void (*write)(Case&, std::size_t) = nullptr;
};
struct PairField {
  Access<double> first, second;
};
/// A CSV file with the points of a curve, relative to the case file: the opening of a port, the
/// stroke of a piston, what drives the shaft over time, the share of a load over time, pitch errors
/// of teeth, deviations of the pistons' clearances, or where all are null the chamber pressure. An
/// empty name: none.
struct CurveField {
  Access<std::filesystem::path> file = {};
  OpeningTable* (*opening)(Case&) = nullptr;
  StrokeTable* (*stroke)(Case&) = nullptr;
  DriveSpec* (*drive)(Case&) = nullptr;
  TimeCurve* (*share)(Case&) = nullptr;
  ToothData* (*teeth)(Case&) = nullptr;
  WallContact* (*walls)(Case&) = nullptr;
};
using Field = std::variant<NumberField, IntegerField, FlagField, TextField, ChoiceField, PairField,
                           CurveField>;

/// The numbers of a field, which may be one, two or none. Allocates nothing: validation of a design
/// asks for them.
struct FieldNumbers {
  std::array<const Access<double>*, 2> places{};
  std::size_t count = 0;
  auto begin() const { return places.begin(); }
  auto end() const { return places.begin() + count; }
};
FieldNumbers numbers_of(const Field& field);

/// A value as a case file has it, in the file's unit; a choice as its word.
using Value = std::variant<double, int, bool, std::string, std::array<double, 2>>;

/// Unit of a number in the file. Its key ends in it.
struct Unit {
  const char* name = "";
  double (*to_si)(double) = nullptr;  ///< null where the number is kept as it is in the file
};

/// A condition on a choice: "kind of [pressure] is one of these words". Never met where empty.
struct When {
  std::string table, key;
  std::vector<std::string> words;
};

/// What a parameter is where the file does not say: nothing (it is required), or a value of the
/// file's unit, fixed or from what has been read before it.
struct Default {
  std::optional<Value> value = {};
  std::optional<Value> (*computed)(const Case&) = nullptr;
  std::string words = {};  ///< of a computed one: "that of [piston]"
};

/// Data that a pump may lack. It is there where its table is, or, as a group of keys within a
/// table, where all its keys without a default are; and it must be there where `needed`.
struct Part {
  When needed;
  bool (*exists)(const Case&) = nullptr;
  void (*create)(Case&) = nullptr;  ///< empty, to be filled in
  void (*remove)(Case&) = nullptr;  ///< where not needed, if not null: read, checked, unused
  /// Where some of its required keys alone, or all of them without what it belongs to, are refused:
  /// what it belongs to, in words.
  const char* belongs_to = nullptr;
};

/// How forces grow with a number: with itself, or with the sine or cosine of an angle.
enum class Scaling { value, sine, cosine };

/// Whether an FMU has a number as its parameter, and whether that may change while it runs: laws of
/// the moment depend on it and states do not.
enum class InFmu { absent, fixed, tunable };

struct Parameter {
  std::string key = {};  ///< in the file, with the unit: "tilt_deg"
  Field field = NumberField{};
  /// Of a number of PumpParameters, its path there: "geometry.tilt"; of a pair both. Filled in by
  /// standard_registry() from the field.
  std::vector<std::string> path = {};
  std::string symbol = {};  ///< in the paper or in docs/
  /// Other words for it, in small letters and without a unit: suggested when one is met as a key.
  std::vector<std::string> also = {};
  Unit unit = {};
  NumberRange range = {};  ///< in the file's unit
  /// The range where it depends on other parameters, in the file's unit; nothing: `range` holds.
  std::optional<NumberRange> (*range_here)(const Case&) = nullptr;
  std::string range_words = {};         ///< for people, where `range` does not say it all
  std::vector<std::string> words = {};  ///< of a choice
  Default fallback = {};
  std::string meaning = {};
  std::string practice = {};  ///< values met in practice, source
  /// When it has something to do; always where empty. Elsewhere its key may stand in the file: it
  /// is checked and unused.
  When active = {};
  const Part* part = nullptr;  ///< within a table that has other keys too
  /// Whether the closed form of a turn has exact derivatives with respect to it in a case; never
  /// where null.
  bool (*differentiable)(const Case&) = nullptr;
  std::optional<InFmu> in_fmu = {};  ///< fixed where nothing says more
  Scaling scaling = Scaling::value;
  /// Of a choice or a count: other values make another model, with other columns or laws.
  bool changes_model = false;
  PlausibleRange plausible = {};  ///< of a number; anything where it gives no reason
  /// The part, or that of the table: filled in by standard_registry().
  const Part* within = nullptr;
};

/// What several parameters must be to each other.
struct Rule {
  std::string key;    ///< whose value is refused
  std::string after;  ///< the last key it needs; "": checked at the end of the table
  /// Why a case is refused, as the end of a message; "" where it is not.
  std::string (*broken)(const Case&) = nullptr;
};

enum class Presence {
  required,
  optional,  ///< where it is missing every key takes its default
  silent,    ///< the same, and a report does not list them
};

/// A table of the case file: "pump", "assumptions.analytic"; "" is the top level.
struct Table {
  std::string name;
  std::string meaning = {};
  Presence presence = Presence::required;
  const Part* part = nullptr;  ///< where the whole table is one
  /// As of Parameter, for entries that do not say it.
  bool (*differentiable)(const Case&) = nullptr;
  std::optional<InFmu> in_fmu = {};
  std::vector<Parameter> parameters = {};
  std::vector<Rule> rules = {};
};

/// All tables in the order in which they are read.
struct Registry {
  std::vector<Table> tables;
};

/// @throws std::logic_error where there is none
const Table& table_of(const Registry& registry, const std::string& name);
const Parameter& parameter_of(const Registry& registry, const std::string& table,
                              const std::string& key);

/// The parameter that is probably meant by a key that `table` does not have, as table.key: one of
/// another table with this key, or one for which this is another word or the symbol.
std::optional<std::string> meant_key(const Registry& registry, const std::string& table,
                                     const std::string& key);
/// The end of a message: that parameter, or else a key of the table with nearly the same letters,
/// or all of them.
std::string key_suggestion(const Registry& registry, const std::string& table,
                           const std::string& key);

/// Whether what the parameter belongs to is in the case.
inline bool is_there(const Parameter& parameter, const Case& the_case) {
  return parameter.within == nullptr || parameter.within->exists(the_case);
}

/// A parameter's value as a file would have it: a number as the shortest one that reads back to the
/// same bits. Nothing where its part is missing or it is kept nowhere.
std::optional<Value> value_of(const Parameter& parameter, const Case& the_case);
/// Puts a value of the file's unit in its place; does nothing where its part is missing.
void store(const Parameter& parameter, Case& the_case, const Value& value);
/// The default here; nothing where the parameter is required.
std::optional<Value> default_of(const Parameter& parameter, const Case& the_case);
/// The range here, in the file's unit.
NumberRange range_of(const Parameter& parameter, const Case& the_case);

bool holds(const When& when, const Registry& registry, const Case& the_case);
/// Whether a parameter has something to do: its condition holds, its part is there, and its table
/// is needed if it ever is.
bool is_active(const Table& table, const Parameter& parameter, const Registry& registry,
               const Case& the_case);
/// The same of a table that is there, needed or not: whether a file may have to say it.
bool is_asked_for(const Parameter& parameter, const Registry& registry, const Case& the_case);

/// A number of the file's unit that the unit converts to `si`, the one with the fewest digits;
/// where there is none, one that is off by a unit in the last place.
double in_file_unit(double si, const Unit& unit);

/// A value as text for people: 40, lumped, true, [1, 2].
std::string to_text(const Value& value);

/// [lumped or real]: the words of a condition as people write it: inertia = "real".
std::string to_text(const When& when);

// Of 1.0, where a view stood for a case: these go with the next major version.
using View [[deprecated("use Case&")]] = Case&;
using ConstView [[deprecated("use const Case&")]] = const Case&;
[[deprecated("pass the case")]] inline Case& view_of(Case& the_case) { return the_case; }
[[deprecated("pass the case")]] inline const Case& view_of(const Case& the_case) {
  return the_case;
}

}  // namespace bentaxis

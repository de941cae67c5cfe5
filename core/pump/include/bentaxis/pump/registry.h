// One description of each parameter: where it stands in a case file, what it means, what it may be,
// and where it is kept. Reading, validation, writing, `--set`, the list that rounding and negative
// controls perturb, the JSON Schema and the tables of docs/ are made from it. A new parameter is
// one entry in standard_registry.cpp, a field, and the physics that uses it.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/pump/standard_registry.h"

namespace bentaxis {

/// What parameters are kept in: a whole case, or a pump alone (then the rest is null).
template <bool kConstant>
struct BasicView {
  template <class T>
  using Pointer = std::conditional_t<kConstant, const T*, T*>;

  Pointer<PumpParameters> pump = nullptr;  ///< never null
  Pointer<std::string> name = nullptr;
  Pointer<BearingRatings> ratings = nullptr;
  Pointer<Operation> operation = nullptr;
  Pointer<PressureSpec> pressure = nullptr;
  Pointer<std::optional<HydraulicData>> hydraulics = nullptr;
  Pointer<std::optional<DriveSpec>> drive = nullptr;
  Pointer<Assumptions> analytic = nullptr, multibody = nullptr;
  Pointer<std::string> meant = nullptr;

  // Parts that need not be there: null where they are not.
  Pointer<PistonMass::Real> real_piston() const { return address(pump->piston.real); }
  Pointer<PortPlate> port_plate() const { return address(pump->port_plate); }
  Pointer<HydraulicData> hydraulic_data() const {
    return hydraulics == nullptr ? nullptr : address(*hydraulics);
  }
  Pointer<ToothCompliance> compliance() const { return address(pump->gear.compliance); }
  Pointer<ToothData> teeth() const { return address(pump->gear.teeth); }
  Pointer<TaperedRating> tapered_rating() const {
    return ratings == nullptr ? nullptr : address(ratings->tapered);
  }
  Pointer<BearingRating> cylindrical_rating() const {
    return ratings == nullptr ? nullptr : address(ratings->cylindrical);
  }
  Pointer<double> ring_contact() const { return address(pump->piston.contact); }
  Pointer<DriveSpec> drive_spec() const { return drive == nullptr ? nullptr : address(*drive); }
  Pointer<MotorData> motor() const {
    return drive_spec() == nullptr ? nullptr : address(drive_spec()->motor);
  }
  Pointer<double> start_speed() const {
    return drive_spec() == nullptr ? nullptr : address(drive_spec()->start_speed);
  }

 private:
  template <class Optional>
  static auto address(Optional& part) -> decltype(&*part) {
    return part ? &*part : nullptr;
  }
};
using View = BasicView<false>;
using ConstView = BasicView<true>;

View view_of(Case& the_case);
View view_of(PumpParameters& pump);
ConstView view_of(const Case& the_case);
ConstView view_of(const PumpParameters& pump);
ConstView as_const(const View& v);

/// Field of a part that may be missing: null where it is.
template <class Part, class Field, class Owner>
auto in(Part* part, Field Owner::*field) -> decltype(&(part->*field)) {
  return part == nullptr ? nullptr : &(part->*field);
}

/// Where a parameter is kept: null functions for what is only checked, as the schema's number; a
/// null result where its part is missing.
template <class T>
struct Access {
  const T* (*read)(const ConstView&) = nullptr;
  T* (*write)(const View&) = nullptr;
};

/// @param place  a lambda without captures that serves both kinds of view and returns a pointer:
///               [](const auto& v) { return &v.pump->geometry.tilt; }
template <class T, class Place>
Access<T> access(Place) {
  return {[](const ConstView& view) -> const T* { return Place{}(view); },
          [](const View& view) -> T* { return Place{}(view); }};
}

// The types of parameters.
struct NumberField {
  Access<double> place;
};
struct IntegerField {
  Access<int> place;
};
struct FlagField {
  Access<bool> place;
};
struct TextField {
  Access<std::string> place;
};
/// An enumeration, whose values are those of the words in their order.
struct ChoiceField {
  std::optional<std::size_t> (*read)(const ConstView&) = nullptr;
  void (*write)(const View&, std::size_t) = nullptr;
};
struct PairField {
  Access<double> first, second;
};
/// A CSV file with the points of a curve, relative to the case file: the opening of a port, what
/// drives the shaft over time, the share of a load over time, pitch errors of teeth, or where all
/// are null the chamber pressure. An empty name: none.
struct CurveField {
  Access<std::filesystem::path> file;
  OpeningTable* (*opening)(const View&) = nullptr;
  DriveSpec* (*drive)(const View&) = nullptr;
  TimeCurve* (*share)(const View&) = nullptr;
  ToothData* (*teeth)(const View&) = nullptr;
};
using Field = std::variant<NumberField, IntegerField, FlagField, TextField, ChoiceField, PairField,
                           CurveField>;

template <class Place>
NumberField number_at(Place place) {
  return {access<double>(place)};
}
template <class Place>
IntegerField integer_at(Place place) {
  return {access<int>(place)};
}
template <class Place>
FlagField flag_at(Place place) {
  return {access<bool>(place)};
}
template <class Place>
TextField text_at(Place place) {
  return {access<std::string>(place)};
}
template <class Place>
ChoiceField choice_at(Place) {
  return {[](const ConstView& view) -> std::optional<std::size_t> {
            const auto* value = Place{}(view);
            if (value == nullptr) return std::nullopt;
            return static_cast<std::size_t>(*value);
          },
          [](const View& view, std::size_t index) {
            if (auto* value = Place{}(view); value != nullptr)
              *value = static_cast<std::remove_pointer_t<decltype(value)>>(index);
          }};
}
template <class First, class Second>
PairField pair_at(First first, Second second) {
  return {access<double>(first), access<double>(second)};
}

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
  std::optional<Value> (*computed)(const ConstView&) = nullptr;
  std::string words = {};  ///< of a computed one: "that of [piston]"
};

/// Data that a pump may lack. It is there where its table is, or, as a group of keys within a
/// table, where all its keys without a default are; and it must be there where `needed`.
struct Part {
  When needed;
  bool (*exists)(const ConstView&) = nullptr;
  void (*create)(const View&) = nullptr;  ///< empty, to be filled in
  void (*remove)(const View&) = nullptr;  ///< where not needed, if not null: read, checked, unused
};

struct Parameter {
  std::string key;  ///< in the file, with the unit: "tilt_deg"
  Field field = NumberField{};
  /// Of a number of PumpParameters, its path there: "geometry.tilt"; of a pair both.
  std::vector<std::string> path = {};
  std::string symbol = {};  ///< in the paper or in docs/
  Unit unit = {};
  NumberRange range = {};  ///< in the file's unit
  /// The range where it depends on other parameters, in the file's unit; nothing: `range` holds.
  std::optional<NumberRange> (*range_here)(const ConstView&) = nullptr;
  std::string range_words = {};         ///< for people, where `range` does not say it all
  std::vector<std::string> words = {};  ///< of a choice
  Default fallback = {};
  std::string meaning = {};
  std::string practice = {};  ///< values met in practice, source
  /// When it has something to do; always where empty. Elsewhere its key may stand in the file: it
  /// is checked and unused.
  When active = {};
  const Part* part = nullptr;  ///< within a table that has other keys too
};

/// What several parameters must be to each other.
struct Rule {
  std::string key;    ///< whose value is refused
  std::string after;  ///< the last key it needs; "": checked at the end of the table
  /// Why a case is refused, as the end of a message; "" where it is not.
  std::string (*broken)(const ConstView&) = nullptr;
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

/// A parameter's value as a file would have it: a number as the shortest one that reads back to the
/// same bits. Nothing where its part is missing or it is kept nowhere.
std::optional<Value> value_of(const Parameter& parameter, const ConstView& view);
/// Puts a value of the file's unit in its place; does nothing where its part is missing.
void store(const Parameter& parameter, const View& view, const Value& value);
/// The default here; nothing where the parameter is required.
std::optional<Value> default_of(const Parameter& parameter, const ConstView& view);
/// The range here, in the file's unit.
NumberRange range_of(const Parameter& parameter, const ConstView& view);

bool holds(const When& when, const Registry& registry, const ConstView& view);
/// Whether a parameter has something to do: its condition holds, its part is there.
bool is_active(const Table& table, const Parameter& parameter, const Registry& registry,
               const ConstView& view);

/// A number of the file's unit that the unit converts to `si`, the one with the fewest digits;
/// where there is none, one that is off by a unit in the last place.
double in_file_unit(double si, const Unit& unit);

/// A value as text for people: 40, lumped, true, [1, 2].
std::string to_text(const Value& value);

/// [lumped or real]: the words of a condition as people write it: inertia = "real".
std::string to_text(const When& when);

}  // namespace bentaxis

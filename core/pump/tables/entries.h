// What the tables of the case file are written with: units, conditions, and where a parameter is
// kept. One file per table; standard_registry.cpp puts them together.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "bentaxis/pump/delivery_side.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::tables {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr NumberRange kCount{1, std::numeric_limits<int>::max()};

// ---- Units: the conversions that results hold to the last bit

inline constexpr Unit kMillimetres{"mm", metres};
inline constexpr Unit kSquareMillimetres{"mm2", square_metres};
inline constexpr Unit kAngle{"deg", radians};            // kept in rad
inline constexpr Unit kDegrees{"deg"};                   // kept in degrees, where edges are exact
inline constexpr Unit kRotation{"rpm", rad_per_second};  // kept in rad/s
inline constexpr Unit kSpeed{"rpm"};                     // kept in rpm
inline constexpr Unit kBar{"bar", pascals};
inline constexpr Unit kKilograms{"kg"};
inline constexpr Unit kInertia{"kg mm2", square_metres};
inline constexpr Unit kNewtons{"N"};
inline constexpr Unit kKilonewtons{"kN", [](double x) { return x * 1e3; }};
inline constexpr Unit kTorquePerSpeed{"Nm/rpm", [](double x) { return x / kRadPerSecondPerRpm; }};
inline constexpr Unit kMegapascals{"MPa", [](double x) { return x * 1e6; }};
inline constexpr Unit kMilliseconds{"ms", [](double x) { return x / 1000; }};
inline constexpr Unit kPercent{"percent", [](double x) { return x / 100; }};
inline constexpr Unit kCubicCentimetres{"cm3", [](double x) { return x / 1e6; }};
inline constexpr Unit kGigapascal{"GPa", [](double x) { return x * 1e9; }};
inline constexpr Unit kMicrometres{"um", [](double x) { return x / 1e6; }};
inline constexpr Unit kStiffness{"N/um", [](double x) { return x * 1e6; }};
inline constexpr Unit kMetres{"m"};
inline constexpr Unit kCentistokes{"cSt", [](double x) { return x / 1e6; }};
inline constexpr Unit kPerGigapascal{"per GPa", [](double x) { return x / 1e9; }};
inline constexpr Unit kLitresPerMinute{"l/min", [](double x) { return x / 6e4; }};
inline constexpr Unit kAreaPerPressure{"mm2/bar", [](double x) { return x / 1e6 / kPascalPerBar; }};
inline constexpr Unit kLitres{"l", [](double x) { return x / 1e3; }};
// 1 l/min = 1e-3/60 m3/s
inline constexpr Unit kLeakage{"l/min/bar", [](double x) { return x / 6e4 / kPascalPerBar; }};
// ---- Conditions that several tables have

inline const When kHydraulic{"pressure", "kind", {"hydraulic"}};
inline const When kTeeth{"gear", "contact", {"teeth"}};
inline const When kGear{"transfer", "kind", {"gear"}};

// ---- Where a parameter is kept

/// Stands for a case where there is a pump alone.
struct PumpAlone {
  PumpParameters& pump;
};

template <class T>
T* address_of(T& place) {
  return &place;
}
template <class T>
T* address_of(std::optional<T>& place) {
  return &*place;
}
template <class T>
const T* address_of(const std::optional<T>& place) {
  return &*place;
}

// A place in the case `c` as a function of cases and pumps, and its text.
// NOLINTNEXTLINE(bugprone-macro-parentheses): a place is a path of members
#define PLACE(place) \
  [](auto& c) -> decltype(address_of(place)) { return address_of(place); }, #place

/// The field of a parameter by its place in the case `c`: FIELD(c.pump.geometry.tilt). Its type is
/// that of the place. What is optional on the way there must be so by the Part of the entry.
#define FIELD(place) kept_at(PLACE(place))
/// Both ends of a place with from_deg and to_deg.
// NOLINTNEXTLINE(bugprone-macro-parentheses): as above
#define ARC(place) pair_at(PLACE(place.from_deg), PLACE(place.to_deg))

/// Of "c.pump.gear.teeth->shaft.runout" its path in PumpParameters, gear.teeth.shaft.runout.
std::string path_in_pump(std::string place);

template <class T, class Place>
Access<T> access(Place, const char* text) {
  Access<T> result;
  result.read = [](const Case& c) -> const T* { return Place{}(c); };
  result.write = [](Case& c) -> T* { return Place{}(c); };
  if constexpr (std::is_invocable_v<Place, PumpAlone&>) {
    result.in_pump = [](PumpParameters& pump) -> T* {
      PumpAlone alone{pump};
      return Place{}(alone);
    };
    result.path = path_in_pump(text);
  }
  return result;
}

/// An enumeration, or a flag that the file has words for.
template <class Place>
ChoiceField choice_at(Place, const char* /*text*/) {
  using T = std::remove_pointer_t<std::invoke_result_t<Place, Case&>>;
  return {[](const Case& c) { return static_cast<std::size_t>(*Place{}(c)); },
          [](Case& c, std::size_t index) { *Place{}(c) = static_cast<T>(index); }};
}

template <class First, class Second>
PairField pair_at(First first, const char* first_text, Second second, const char* second_text) {
  return {access<double>(first, first_text), access<double>(second, second_text)};
}

/// @param points  where the curve's points go
template <class Place>
CurveField curve_at(Place place, const char* text, CurveField points = {}) {
  points.file = access<std::filesystem::path>(place, text);
  return points;
}

template <class Place>
Field kept_at(Place place, const char* text) {
  using T = std::remove_pointer_t<std::invoke_result_t<Place, Case&>>;
  if constexpr (std::is_constructible_v<Field, PlainField<T>>)
    return PlainField<T>{access<T>(place, text)};
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    return curve_at(place, text);
  else
    return choice_at(place, text);
}

// ---- Entries, in the order of the columns of docs/case_file.md; `more` says by name what few have

inline constexpr Unit kNoUnit{};
inline const Default kRequired{};

/// A number, a whole number or a pair.
Parameter number(std::string key, std::string symbol, Field field, Unit unit, NumberRange range,
                 Default fallback, std::string meaning, Parameter more = {});
Parameter choice(std::string key, Field field, std::vector<std::string> words, Default fallback,
                 std::string meaning, Parameter more = {});
Parameter choice(std::string key, Field field, std::vector<std::string> words, const char* fallback,
                 std::string meaning, Parameter more = {});
Parameter flag(std::string key, Field field, bool fallback, std::string meaning);
/// A text or a file; empty where the case does not give it.
Parameter text(std::string key, Field field, std::string meaning, Parameter more = {});
Parameter required_text(std::string key, Field field, std::string meaning, Parameter more = {});

/// Rules that are checked once the key is read, and at the end of its table.
inline Rule after(const std::string& key, std::string (*broken)(const Case&)) {
  return {key, key, broken};
}
inline Rule at_end(const std::string& key, std::string (*broken)(const Case&)) {
  return {key, "", broken};
}

// ---- Data that a case may lack

/// @param place  of an optional in a case; may return null where what it lies in is missing
template <class Place>
Part part_at(Place, When needed = {}) {
  return {std::move(needed),
          [](const Case& c) {
            const auto* const part = Place{}(c);
            return part != nullptr && part->has_value();
          },
          [](Case& c) {
            if (auto* const part = Place{}(c); part != nullptr)
              *part = typename std::remove_reference_t<decltype(*part)>::value_type{};
          }};
}

/// Of the hydraulic data, with a table of its own.
template <auto kMember>
Part part_of_hydraulics() {
  return part_at([](auto& c) { return c.hydraulics ? &(*c.hydraulics.*kMember) : nullptr; });
}
/// The same in a case; null where it is missing.
template <class T>
const T* find(const Case& c, std::optional<T> HydraulicData::*member) {
  return c.hydraulics && *c.hydraulics.*member ? &*(*c.hydraulics.*member) : nullptr;
}

// ---- Derivatives

inline bool always(const Case& /*the_case*/) { return true; }

// ---- Rules that several tables have

/// A computed number for a message, to six digits.
std::string short_text(double value);
/// "" where from < to <= from + 360.
std::string arc_refusal(const PortArc& arc);

// ---- The tables

Table top_level();
Table pump_table();
Table transfer_table();
Table gear_table();
Table bearings_table();
Table piston_table();
Table shaft_table();
Table block_table();
Table friction_table();
Table operation_table();
Table drive_table();
Table pressure_table();
Table port_plate_table();
Table hydraulics_table();
Table oil_table();
Table leakage_table();
Table suction_line_table();
Table delivery_line_table();
Table load_table();
Table accumulator_table();
Table loop_table();
Table analytic_assumptions_table();
Table multibody_assumptions_table();
Table plausibility_table();

}  // namespace bentaxis::tables

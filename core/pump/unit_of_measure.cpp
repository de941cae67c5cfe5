#include "bentaxis/pump/unit_of_measure.h"

#include <map>
#include <stdexcept>

#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

using Units = std::vector<UnitOfMeasure>;

constexpr double kPoundForce = 4.4482216152605;
constexpr double kKilogramForce = 9.80665;
constexpr double kInch = 0.0254;
constexpr double kMinute = 60;  // s

constexpr Dimension kLength{.m = 1};
constexpr Dimension kVolume{.m = 3};
constexpr Dimension kAngle{.rad = 1};
constexpr Dimension kTime{.s = 1};
constexpr Dimension kRate{.s = -1};
constexpr Dimension kAngularVelocity{.s = -1, .rad = 1};
constexpr Dimension kForce{.kg = 1, .m = 1, .s = -2};
constexpr Dimension kTorque{.kg = 1, .m = 2, .s = -2};
constexpr Dimension kPower{.kg = 1, .m = 2, .s = -3};
constexpr Dimension kInertia{.kg = 1, .m = 2};
constexpr Dimension kRotationalDamping{.kg = 1, .m = 2, .s = -1, .rad = -1};
constexpr Dimension kPressure{.kg = 1, .m = -1, .s = -2};
constexpr Dimension kVolumeFlow{.m = 3, .s = -1};

void add_shapes(Units& all) {
  const auto length = [&](const char* name, double factor, std::vector<std::string> spellings,
                          std::vector<std::string> words) {
    all.push_back({.name = name,
                   .quantity = "Length",
                   .dimension = kLength,
                   .factor = factor,
                   .spellings = std::move(spellings),
                   .words = std::move(words)});
  };
  length("m", 1, {}, {"meter", "metre"});
  all.back().display = "mm";
  all.back().display_factor = 1e3;
  length("cm", 1e-2, {}, {});
  length("mm", 1e-3, {}, {"millimeter", "millimetre"});
  length("um", 1e-6, {"µm"}, {});
  length("in", kInch, {}, {"inch"});
  all.push_back({.name = "mm2", .quantity = "Area", .dimension = {.m = 2}, .factor = 1e-6});
  all.push_back({.name = "m3",
                 .quantity = "Volume",
                 .dimension = kVolume,
                 .display = "L",
                 .display_factor = 1e3});
  all.push_back({.name = "cm3", .quantity = "Volume", .dimension = kVolume, .factor = 1e-6});
  all.push_back(
      {.name = "l", .quantity = "Volume", .dimension = kVolume, .factor = 1e-3, .standard = "L"});
  const auto angle = [&](const char* name, double factor, std::vector<std::string> spellings,
                         std::vector<std::string> words) {
    all.push_back({.name = name,
                   .quantity = "Angle",
                   .dimension = kAngle,
                   .factor = factor,
                   .spellings = std::move(spellings),
                   .words = std::move(words)});
  };
  angle("rad", 1, {}, {"radian", "radians"});
  all.back().display = "deg";
  all.back().display_factor = 180 / kPi;
  angle("mrad", 1e-3, {}, {});
  angle("urad", 1e-6, {}, {});
  angle("deg", kRadPerDegree, {"°", "\xB0"}, {"degree", "degrees", "grad°", "deg"});
  angle("gon", 0.9 * kRadPerDegree, {"grad"}, {});
  angle("turn", 360 * kRadPerDegree, {"rev"}, {"revolution", "revolutions", "turns", "umdr"});
  all.push_back({.name = "percent", .quantity = "Share", .factor = 1e-2, .standard = "%"});
}

void add_motion(Units& all) {
  const auto time = [&](const char* name, double factor, std::vector<std::string> spellings,
                        std::vector<std::string> words) {
    all.push_back({.name = name,
                   .quantity = "Time",
                   .dimension = kTime,
                   .factor = factor,
                   .spellings = std::move(spellings),
                   .words = std::move(words)});
  };
  time("s", 1, {}, {"sec", "second", "seconds", "sek"});
  time("ms", 1e-3, {}, {"millisecond", "milliseconds", "msec"});
  time("us", 1e-6, {"µs"}, {});
  time("min", kMinute, {}, {"minutes"});
  all.push_back({.name = "Hz", .quantity = "Frequency", .dimension = kRate});
  all.push_back({.name = "1/s", .quantity = "Rate", .dimension = kRate});
  all.push_back({.name = "1/min", .quantity = "Rate", .dimension = kRate, .factor = 1 / kMinute});
  all.push_back({.name = "m/s", .quantity = "Velocity", .dimension = {.m = 1, .s = -1}});
  all.push_back({.name = "m/s2", .quantity = "Acceleration", .dimension = {.m = 1, .s = -2}});
  all.push_back({.name = "s/m", .quantity = "Dissipation", .dimension = {.m = -1, .s = 1}});
  const auto speed = [&](const char* name, double factor, std::vector<std::string> spellings = {}) {
    all.push_back({.name = name,
                   .quantity = "AngularVelocity",
                   .dimension = kAngularVelocity,
                   .factor = factor,
                   .spellings = std::move(spellings)});
  };
  speed("rpm", kRadPerSecondPerRpm, {"rev/min"});
  speed("deg/s", kRadPerDegree);
  speed("rad/s", 1);
  all.back().display = "rpm";
  all.back().display_factor = 30 / kPi;
  all.push_back({.name = "rad/s2",
                 .quantity = "AngularAcceleration",
                 .dimension = {.s = -2, .rad = 1},
                 .spellings = {"rad/s^2"}});
}

void add_forces(Units& all) {
  const auto force = [&](const char* name, double factor, std::vector<std::string> spellings,
                         std::vector<std::string> words) {
    all.push_back({.name = name,
                   .quantity = "Force",
                   .dimension = kForce,
                   .factor = factor,
                   .spellings = std::move(spellings),
                   .words = std::move(words)});
  };
  force("N", 1, {}, {"newton", "newtons", "n"});
  force("kN", 1e3, {"KN"}, {"kilonewton", "knewton"});
  force("MN", 1e6, {}, {});
  force("daN", 10, {}, {});
  force("kgf", kKilogramForce, {}, {"kilogramforce"});
  force("lbf", kPoundForce, {}, {"poundforce"});
  const auto torque = [&](const char* name, const char* standard, double factor,
                          std::vector<std::string> spellings, std::vector<std::string> words) {
    all.push_back({.name = name,
                   .quantity = "Torque",
                   .dimension = kTorque,
                   .factor = factor,
                   .standard = standard,
                   .spellings = std::move(spellings),
                   .words = std::move(words)});
  };
  torque("Nm", "N.m", 1, {"N*m"}, {"newtonmeter", "newtonmetre", "newtonm", "nm"});
  torque("kNm", "kN.m", 1e3, {}, {"kilonewtonmeter", "kilonewtonm"});
  torque("Nmm", "N.mm", 1e-3, {"mNm"}, {"newtonmm", "newtonmillimeter", "nmm"});
  torque("lbf in", "", kPoundForce * kInch, {"lbfin", "inlbf"}, {"poundforceinch"});
  torque("lbf ft", "", kPoundForce * 12 * kInch, {"lbfft", "ftlbf"}, {});
  all.push_back({.name = "J", .quantity = "Energy", .dimension = kTorque});
  all.push_back({.name = "W", .quantity = "Power", .dimension = kPower});
  all.push_back({.name = "kW", .quantity = "Power", .dimension = kPower, .factor = 1e3});
  all.push_back({.name = "kg", .quantity = "Mass", .dimension = {.kg = 1}});
  all.push_back(
      {.name = "kg m2", .quantity = "MomentOfInertia", .dimension = kInertia, .standard = "kg.m2"});
  all.push_back({.name = "kg mm2",
                 .quantity = "MomentOfInertia",
                 .dimension = kInertia,
                 .factor = 1e-6,
                 .standard = "kg.mm2"});
  all.push_back(
      {.name = "N/um", .quantity = "Stiffness", .dimension = {.kg = 1, .s = -2}, .factor = 1e6});
  all.push_back({.name = "N s/m",
                 .quantity = "Damping",
                 .dimension = {.kg = 1, .s = -1},
                 .standard = "N.s/m"});
  all.push_back({.name = "Nm/rad",
                 .quantity = "RotationalStiffness",
                 .dimension = {.kg = 1, .m = 2, .s = -2, .rad = -1},
                 .standard = "N.m/rad"});
  all.push_back({.name = "Nm s/rad",
                 .quantity = "RotationalDamping",
                 .dimension = kRotationalDamping,
                 .standard = "N.m.s/rad"});
  all.push_back({.name = "Nm/rpm",
                 .quantity = "RotationalDamping",
                 .dimension = kRotationalDamping,
                 .factor = 1 / kRadPerSecondPerRpm,
                 .standard = "N.m/rpm"});
}

void add_oil(Units& all) {
  const auto pressure = [&](const char* name, double factor, std::vector<std::string> spellings,
                            std::vector<std::string> words) {
    all.push_back({.name = name,
                   .quantity = "Pressure",
                   .dimension = kPressure,
                   .factor = factor,
                   .spellings = std::move(spellings),
                   .words = std::move(words)});
  };
  pressure("Pa", 1, {}, {"pascal"});
  all.back().display = "bar";
  all.back().display_factor = 1 / kPascalPerBar;
  pressure("kPa", 1e3, {}, {});
  pressure("MPa", 1e6, {"N/mm2", "N/mm^2", "N/mm²"}, {"megapascal", "mpa"});
  pressure("GPa", 1e9, {}, {});
  pressure("bar", kPascalPerBar, {}, {});
  pressure("mbar", 1e2, {}, {});
  pressure("psi", 6894.757293168361, {}, {});
  all.push_back(
      {.name = "Pa/s", .quantity = "PressureRate", .dimension = {.kg = 1, .m = -1, .s = -3}});
  all.push_back({.name = "per GPa",
                 .quantity = "Compressibility",
                 .dimension = {.kg = -1, .m = 1, .s = 2},
                 .factor = 1e-9,
                 .standard = "1/GPa"});
  all.push_back({.name = "kg/m3", .quantity = "Density", .dimension = {.kg = 1, .m = -3}});
  all.push_back({.name = "kg/s", .quantity = "MassFlowRate", .dimension = {.kg = 1, .s = -1}});
  all.push_back({.name = "m3/s",
                 .quantity = "VolumeFlowRate",
                 .dimension = kVolumeFlow,
                 .display = "L/min",
                 .display_factor = 1 / kLitrePerMinute,
                 .spellings = {"m^3/s"}});
  all.push_back({.name = "l/min",
                 .quantity = "VolumeFlowRate",
                 .dimension = kVolumeFlow,
                 .factor = kLitrePerMinute,
                 .standard = "L/min"});
  all.push_back({.name = "l/min/bar",
                 .quantity = "HydraulicConductance",
                 .dimension = {.kg = -1, .m = 4, .s = 1},
                 .factor = kLitrePerMinute / kPascalPerBar,
                 .standard = "L/(min.bar)"});
  all.push_back({.name = "mm2/bar",
                 .quantity = "AreaPerPressure",
                 .dimension = {.kg = -1, .m = 3, .s = 2},
                 .factor = 1e-6 / kPascalPerBar});
  all.push_back({.name = "cSt",
                 .quantity = "KinematicViscosity",
                 .dimension = {.m = 2, .s = -1},
                 .factor = 1e-6});
  all.push_back({.name = "C",
                 .quantity = "Temperature",
                 .dimension = {.kelvin = 1},
                 .offset = 273.15,
                 .standard = "degC"});
}

using Index = std::map<std::string, const UnitOfMeasure*, std::less<>>;

struct Indices {
  Index names, written, words;
};

const Indices& indices() {
  static const Indices all = [] {
    Indices made;
    for (const UnitOfMeasure& unit : units_of_measure()) {
      made.names.emplace(unit.name, &unit);
      made.written.emplace(unit.name, &unit);
      made.written.emplace(unit.standard, &unit);
      for (const std::string& text : unit.spellings) made.written.emplace(text, &unit);
      for (const std::string& word : unit.words) made.words.emplace(word, &unit);
    }
    return made;
  }();
  return all;
}

const UnitOfMeasure* find(const Index& index, std::string_view text) {
  const auto found = index.find(text);
  return found == index.end() ? nullptr : found->second;
}

}  // namespace

const std::vector<UnitOfMeasure>& units_of_measure() {
  static const Units all = [] {
    Units made;
    add_shapes(made);
    add_motion(made);
    add_forces(made);
    add_oil(made);
    for (UnitOfMeasure& unit : made)
      if (unit.standard.empty()) unit.standard = unit.name;
    return made;
  }();
  return all;
}

const UnitOfMeasure* find_unit_of_measure(std::string_view name) {
  return find(indices().names, name);
}
const UnitOfMeasure* find_written_unit(std::string_view text) {
  return find(indices().written, text);
}
const UnitOfMeasure* find_unit_by_word(std::string_view word) {
  return find(indices().words, word);
}

double unit_in_si(std::string_view name) {
  if (name.empty() || name == "-") return 1;
  if (const UnitOfMeasure* const unit = find_unit_of_measure(name)) return unit->factor;
  throw std::logic_error("core/pump/unit_of_measure.cpp has no unit " + std::string(name));
}

}  // namespace bentaxis

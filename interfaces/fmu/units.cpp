#include "units.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>

#include "bentaxis/pump/units.h"

namespace bentaxis::fmu {
namespace {

using Table = std::map<std::string, UnitDefinition, std::less<>>;

void add_shapes(Table& all) {
  all["m"] = {.name = "m", .quantity = "Length", .m = 1, .display = "mm", .display_factor = 1e3};
  all["mm"] = {.name = "mm", .quantity = "Length", .m = 1, .factor = 1e-3};
  all["um"] = {.name = "um", .quantity = "Length", .m = 1, .factor = 1e-6};
  all["mm2"] = {.name = "mm2", .quantity = "Area", .m = 2, .factor = 1e-6};
  all["m3"] = {.name = "m3", .quantity = "Volume", .m = 3, .display = "L", .display_factor = 1e3};
  all["cm3"] = {.name = "cm3", .quantity = "Volume", .m = 3, .factor = 1e-6};
  all["l"] = {.name = "L", .quantity = "Volume", .m = 3, .factor = 1e-3};
  all["rad"] = {
      .name = "rad", .quantity = "Angle", .rad = 1, .display = "deg", .display_factor = 180 / kPi};
  all["deg"] = {.name = "deg", .quantity = "Angle", .rad = 1, .factor = kRadPerDegree};
  all["percent"] = {.name = "%", .quantity = "Share", .factor = 1e-2};
}

void add_motion(Table& all) {
  all["s"] = {.name = "s", .quantity = "Time", .s = 1};
  all["ms"] = {.name = "ms", .quantity = "Time", .s = 1, .factor = 1e-3};
  all["Hz"] = {.name = "Hz", .quantity = "Frequency", .s = -1};
  all["1/s"] = {.name = "1/s", .quantity = "Rate", .s = -1};
  all["m/s"] = {.name = "m/s", .quantity = "Velocity", .m = 1, .s = -1};
  all["m/s2"] = {.name = "m/s2", .quantity = "Acceleration", .m = 1, .s = -2};
  all["s/m"] = {.name = "s/m", .quantity = "Dissipation", .m = -1, .s = 1};
  all["rpm"] = {.name = "rpm",
                .quantity = "AngularVelocity",
                .s = -1,
                .rad = 1,
                .factor = kRadPerSecondPerRpm};
  all["rad/s"] = {.name = "rad/s",
                  .quantity = "AngularVelocity",
                  .s = -1,
                  .rad = 1,
                  .display = "rpm",
                  .display_factor = 30 / kPi};
  all["rad/s2"] = {.name = "rad/s2", .quantity = "AngularAcceleration", .s = -2, .rad = 1};
}

void add_forces(Table& all) {
  all["N"] = {.name = "N", .quantity = "Force", .kg = 1, .m = 1, .s = -2};
  all["kN"] = {.name = "kN", .quantity = "Force", .kg = 1, .m = 1, .s = -2, .factor = 1e3};
  all["Nm"] = {.name = "N.m", .quantity = "Torque", .kg = 1, .m = 2, .s = -2};
  all["W"] = {.name = "W", .quantity = "Power", .kg = 1, .m = 2, .s = -3};
  all["J"] = {.name = "J", .quantity = "Energy", .kg = 1, .m = 2, .s = -2};
  all["kg"] = {.name = "kg", .quantity = "Mass", .kg = 1};
  all["kg m2"] = {.name = "kg.m2", .quantity = "MomentOfInertia", .kg = 1, .m = 2};
  all["kg mm2"] = {
      .name = "kg.mm2", .quantity = "MomentOfInertia", .kg = 1, .m = 2, .factor = 1e-6};
  all["N/um"] = {.name = "N/um", .quantity = "Stiffness", .kg = 1, .s = -2, .factor = 1e6};
  all["N s/m"] = {.name = "N.s/m", .quantity = "Damping", .kg = 1, .s = -1};
  all["Nm/rad"] = {
      .name = "N.m/rad", .quantity = "RotationalStiffness", .kg = 1, .m = 2, .s = -2, .rad = -1};
  all["Nm s/rad"] = {
      .name = "N.m.s/rad", .quantity = "RotationalDamping", .kg = 1, .m = 2, .s = -1, .rad = -1};
  all["Nm/rpm"] = {.name = "N.m/rpm",
                   .quantity = "RotationalDamping",
                   .kg = 1,
                   .m = 2,
                   .s = -1,
                   .rad = -1,
                   .factor = 1 / kRadPerSecondPerRpm};
}

void add_oil(Table& all) {
  const auto pressure = [](const char* name, double factor) {
    return UnitDefinition{
        .name = name, .quantity = "Pressure", .kg = 1, .m = -1, .s = -2, .factor = factor};
  };
  all["Pa"] = pressure("Pa", 1);
  all["Pa"].display = "bar";
  all["Pa"].display_factor = 1 / kPascalPerBar;
  all["bar"] = pressure("bar", kPascalPerBar);
  all["MPa"] = pressure("MPa", 1e6);
  all["GPa"] = pressure("GPa", 1e9);
  all["Pa/s"] = {.name = "Pa/s", .quantity = "PressureRate", .kg = 1, .m = -1, .s = -3};
  all["per GPa"] = {
      .name = "1/GPa", .quantity = "Compressibility", .kg = -1, .m = 1, .s = 2, .factor = 1e-9};
  all["kg/m3"] = {.name = "kg/m3", .quantity = "Density", .kg = 1, .m = -3};
  all["kg/s"] = {.name = "kg/s", .quantity = "MassFlowRate", .kg = 1, .s = -1};
  all["m3/s"] = {.name = "m3/s",
                 .quantity = "VolumeFlowRate",
                 .m = 3,
                 .s = -1,
                 .display = "L/min",
                 .display_factor = 1 / kLitrePerMinute};
  all["l/min"] = {
      .name = "L/min", .quantity = "VolumeFlowRate", .m = 3, .s = -1, .factor = kLitrePerMinute};
  all["l/min/bar"] = {.name = "L/(min.bar)",
                      .quantity = "HydraulicConductance",
                      .kg = -1,
                      .m = 4,
                      .s = 1,
                      .factor = kLitrePerMinute / kPascalPerBar};
  all["mm2/bar"] = {.name = "mm2/bar",
                    .quantity = "AreaPerPressure",
                    .kg = -1,
                    .m = 3,
                    .s = 2,
                    .factor = 1e-6 / kPascalPerBar};
  all["cSt"] = {.name = "cSt", .quantity = "KinematicViscosity", .m = 2, .s = -1, .factor = 1e-6};
  all["C"] = {.name = "degC", .quantity = "Temperature", .kelvin = 1, .offset = 273.15};
}

const Table& table() {
  static const Table all = [] {
    Table made;
    add_shapes(made);
    add_motion(made);
    add_forces(made);
    add_oil(made);
    return made;
  }();
  return all;
}

}  // namespace

std::string type_name(const UnitDefinition& unit) {
  std::string name = unit.quantity + "_" + (unit.name == "%" ? "percent" : unit.name);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

const UnitDefinition* unit_definition(std::string_view unit) {
  if (unit.empty() || unit == "-") return nullptr;
  const auto found = table().find(unit);
  if (found == table().end())
    throw std::logic_error("fmu/units.cpp does not know the unit " + std::string(unit));
  return &found->second;
}

std::vector<const UnitDefinition*> unit_definitions(const std::vector<std::string>& units) {
  std::vector<const UnitDefinition*> needed;
  for (const std::string& unit : units) {
    const UnitDefinition* definition = unit_definition(unit);
    if (definition != nullptr &&
        std::find(needed.begin(), needed.end(), definition) == needed.end())
      needed.push_back(definition);
  }
  return needed;
}

}  // namespace bentaxis::fmu

#include "units.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "bentaxis/pump/units.h"

namespace bentaxis::fmu {
namespace {

using Table = std::map<std::string, UnitDefinition, std::less<>>;

void add_shapes(Table& all) {
  all["m"] = {.name = "m", .m = 1, .display = "mm", .display_factor = 1e3};
  all["mm"] = {.name = "mm", .m = 1, .factor = 1e-3};
  all["um"] = {.name = "um", .m = 1, .factor = 1e-6};
  all["mm2"] = {.name = "mm2", .m = 2, .factor = 1e-6};
  all["m3"] = {.name = "m3", .m = 3, .display = "L", .display_factor = 1e3};
  all["cm3"] = {.name = "cm3", .m = 3, .factor = 1e-6};
  all["l"] = {.name = "L", .m = 3, .factor = 1e-3};
  all["rad"] = {.name = "rad", .rad = 1, .display = "deg", .display_factor = 180 / kPi};
  all["deg"] = {.name = "deg", .rad = 1, .factor = kRadPerDegree};
  all["percent"] = {.name = "%", .factor = 1e-2};
}

void add_motion(Table& all) {
  all["s"] = {.name = "s", .s = 1};
  all["ms"] = {.name = "ms", .s = 1, .factor = 1e-3};
  all["Hz"] = {.name = "Hz", .s = -1};
  all["1/s"] = {.name = "1/s", .s = -1};
  all["m/s"] = {.name = "m/s", .m = 1, .s = -1};
  all["m/s2"] = {.name = "m/s2", .m = 1, .s = -2};
  all["s/m"] = {.name = "s/m", .m = -1, .s = 1};
  all["rpm"] = {.name = "rpm", .s = -1, .rad = 1, .factor = kRadPerSecondPerRpm};
  all["rad/s"] = {.name = "rad/s", .s = -1, .rad = 1, .display = "rpm", .display_factor = 30 / kPi};
  all["rad/s2"] = {.name = "rad/s2", .s = -2, .rad = 1};
}

void add_forces(Table& all) {
  all["N"] = {.name = "N", .kg = 1, .m = 1, .s = -2};
  all["kN"] = {.name = "kN", .kg = 1, .m = 1, .s = -2, .factor = 1e3};
  all["Nm"] = {.name = "N.m", .kg = 1, .m = 2, .s = -2};
  all["W"] = {.name = "W", .kg = 1, .m = 2, .s = -3};
  all["J"] = {.name = "J", .kg = 1, .m = 2, .s = -2};
  all["kg"] = {.name = "kg", .kg = 1};
  all["kg m2"] = {.name = "kg.m2", .kg = 1, .m = 2};
  all["kg mm2"] = {.name = "kg.mm2", .kg = 1, .m = 2, .factor = 1e-6};
  all["N/um"] = {.name = "N/um", .kg = 1, .s = -2, .factor = 1e6};
  all["N s/m"] = {.name = "N.s/m", .kg = 1, .s = -1};
  all["Nm/rad"] = {.name = "N.m/rad", .kg = 1, .m = 2, .s = -2, .rad = -1};
  all["Nm s/rad"] = {.name = "N.m.s/rad", .kg = 1, .m = 2, .s = -1, .rad = -1};
  all["Nm/rpm"] = {
      .name = "N.m/rpm", .kg = 1, .m = 2, .s = -1, .rad = -1, .factor = 1 / kRadPerSecondPerRpm};
}

void add_oil(Table& all) {
  const auto pressure = [](const char* name, double factor) {
    return UnitDefinition{.name = name, .kg = 1, .m = -1, .s = -2, .factor = factor};
  };
  all["Pa"] = pressure("Pa", 1);
  all["Pa"].display = "bar";
  all["Pa"].display_factor = 1 / kPascalPerBar;
  all["bar"] = pressure("bar", kPascalPerBar);
  all["MPa"] = pressure("MPa", 1e6);
  all["GPa"] = pressure("GPa", 1e9);
  all["Pa/s"] = {.name = "Pa/s", .kg = 1, .m = -1, .s = -3};
  all["per GPa"] = {.name = "1/GPa", .kg = -1, .m = 1, .s = 2, .factor = 1e-9};
  all["kg/m3"] = {.name = "kg/m3", .kg = 1, .m = -3};
  all["kg/s"] = {.name = "kg/s", .kg = 1, .s = -1};
  all["m3/s"] = {
      .name = "m3/s", .m = 3, .s = -1, .display = "L/min", .display_factor = 1 / kLitrePerMinute};
  all["l/min"] = {.name = "L/min", .m = 3, .s = -1, .factor = kLitrePerMinute};
  all["l/min/bar"] = {
      .name = "L/(min.bar)", .kg = -1, .m = 4, .s = 1, .factor = kLitrePerMinute / kPascalPerBar};
  all["mm2/bar"] = {.name = "mm2/bar", .kg = -1, .m = 3, .s = 2, .factor = 1e-6 / kPascalPerBar};
  all["cSt"] = {.name = "cSt", .m = 2, .s = -1, .factor = 1e-6};
  all["C"] = {.name = "degC", .kelvin = 1, .offset = 273.15};
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

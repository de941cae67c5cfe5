// Units of measure: by exponents of base units, or by their usual names.
#include <map>

#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::fmu {
namespace {

Measure of(int kg, int m, int s, double factor = 1, int rad = 0) {
  return {{kg, m, s, 0, 0, 0, 0, rad}, factor, 0};
}

const std::map<std::string, Measure, std::less<>>& usual_names() {
  constexpr double kMinute = 60;
  static const std::map<std::string, Measure, std::less<>> names = {
      {"", of(0, 0, 0)},
      {"-", of(0, 0, 0)},
      {"1", of(0, 0, 0)},
      {"%", of(0, 0, 0, 1e-2)},
      {"s", of(0, 0, 1)},
      {"m", of(0, 1, 0)},
      {"mm", of(0, 1, 0, 1e-3)},
      {"m/s", of(0, 1, -1)},
      {"N", of(1, 1, -2)},
      {"kN", of(1, 1, -2, 1e3)},
      {"N.m", of(1, 2, -2)},
      {"Nm", of(1, 2, -2)},
      {"N*m", of(1, 2, -2)},
      {"J", of(1, 2, -2)},
      {"W", of(1, 2, -3)},
      {"kW", of(1, 2, -3, 1e3)},
      {"Pa", of(1, -1, -2)},
      {"kPa", of(1, -1, -2, 1e3)},
      {"MPa", of(1, -1, -2, 1e6)},
      {"bar", of(1, -1, -2, kPascalPerBar)},
      {"rad", of(0, 0, 0, 1, 1)},
      {"deg", of(0, 0, 0, kRadPerDegree, 1)},
      {"rad/s", of(0, 0, -1, 1, 1)},
      {"deg/s", of(0, 0, -1, kRadPerDegree, 1)},
      {"rpm", of(0, 0, -1, kRadPerSecondPerRpm, 1)},
      {"rev/min", of(0, 0, -1, kRadPerSecondPerRpm, 1)},
      {"rad/s2", of(0, 0, -2, 1, 1)},
      {"rad/s^2", of(0, 0, -2, 1, 1)},
      {"m3/s", of(0, 3, -1)},
      {"m^3/s", of(0, 3, -1)},
      {"L/min", of(0, 3, -1, kLitrePerMinute)},
      {"l/min", of(0, 3, -1, kLitrePerMinute)},
      {"m3", of(0, 3, 0)},
      {"kg", of(1, 0, 0)},
      {"kg/s", of(1, 0, -1)},
      {"1/s", of(0, 0, -1)},
      {"Hz", of(0, 0, -1)},
      {"1/min", of(0, 0, -1, 1 / kMinute)},
  };
  return names;
}

}  // namespace

bool same_quantity(const Measure& a, const Measure& b) { return a.exponents == b.exponents; }

double converted(double value, const Measure& from, const Measure& to) {
  if (from.factor == to.factor && from.offset == to.offset) return value;
  return (from.factor * value + from.offset - to.offset) / to.factor;
}

std::optional<Measure> measure_named(std::string_view name) {
  const auto found = usual_names().find(name);
  if (found == usual_names().end()) return std::nullopt;
  return found->second;
}

}  // namespace bentaxis::fmu

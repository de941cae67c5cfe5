// Units of measure: by exponents of base units, or by their usual names.
#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/unit_of_measure.h"

namespace bentaxis::fmu {

bool same_quantity(const Measure& a, const Measure& b) { return a.exponents == b.exponents; }

double converted(double value, const Measure& from, const Measure& to) {
  if (from.factor == to.factor && from.offset == to.offset) return value;
  return (from.factor * value + from.offset - to.offset) / to.factor;
}

std::optional<Measure> measure_named(std::string_view name) {
  if (name.empty() || name == "-" || name == "1") return Measure{};
  const UnitOfMeasure* const found = find_written_unit(name);
  if (found == nullptr) return std::nullopt;
  const Dimension& d = found->dimension;
  return Measure{{d.kg, d.m, d.s, 0, d.kelvin, 0, 0, d.rad}, found->factor, found->offset};
}

}  // namespace bentaxis::fmu

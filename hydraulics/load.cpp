#include "load.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bentaxis::hydraulics {

Load::Load(const LoadData& data, const Orifice& orifice, const Fluid& fluid, double given_mass_flow,
           bool both_ways)
    : data_(data),
      orifice_(orifice),
      outside_(fluid.state(0)),
      given_(given_mass_flow),
      both_ways_(both_ways) {}

bool Load::sought() const {
  return data_.kind != LoadKind::constant_pressure && !data_.sets_pressure();
}

double Load::size() const {
  switch (data_.kind) {
    case LoadKind::orifice:
      return data_.area;
    case LoadKind::laminar:
      return data_.conductance;
    case LoadKind::relief_valve:
      return data_.cracking_pressure + outside_.pressure;
    case LoadKind::flow:
      return 1;
    case LoadKind::constant_pressure:
      break;
  }
  return 0;
}

double Load::closed() const {
  return data_.kind == LoadKind::relief_valve ? std::numeric_limits<double>::infinity() : 0;
}

double Load::shared(double size, double share) const {
  if (data_.kind != LoadKind::relief_valve) return size * share;
  return outside_.pressure + (size - outside_.pressure) * share;
}

double Load::size_for(double mass_flow, const Side& side, const Side& outside) const {
  const double one = orifice_.flow(1, side, outside).value;
  if (data_.kind == LoadKind::laminar) return mass_flow / through_load(side, outside, 1).value;
  if (data_.kind != LoadKind::relief_valve) return mass_flow / one;
  const double area = std::min(mass_flow / one, data_.full_area);
  const double over = outside.pressure - outside_.pressure;
  return std::max(side.pressure - area / data_.opening - over, outside_.pressure);
}

Load::Flow Load::flow(const Side& side, const Side& outside, double size) const {
  Flow all = through_load(side, outside, size);
  if (!data_.has_relief()) return all;
  const Flow relief = through_valve(side, outside, data_.relief_pressure + outside_.pressure);
  all.value += relief.value;
  all.by_side += relief.by_side;
  all.by_outside += relief.by_outside;
  all.relief = relief.value;
  return all;
}

Load::Flow Load::one_way(const Side& side, const Side& outside, double size) const {
  const double area =
      data_.opening * (side.pressure - (size + (outside.pressure - outside_.pressure)));
  if (!(area > 0)) return {};
  if (area >= data_.full_area) {
    const MassFlow full = orifice_.flow(data_.full_area, side, outside);
    return {full.value, full.by_first, 0, full.by_second};
  }
  const MassFlow through = orifice_.flow(area, side, outside);
  const double per_pressure = data_.opening * through.value / area;
  return {through.value, through.by_first + per_pressure * side.slope, -per_pressure * size,
          through.by_second - per_pressure * outside.slope};
}

Load::Flow Load::through_valve(const Side& side, const Side& outside, double size) const {
  if (!both_ways_ || side.pressure >= outside.pressure) return one_way(side, outside, size);
  const Flow back = one_way(outside, side, size);
  return {-back.value, -back.by_outside, -back.by_size, -back.by_side};
}

Load::Flow Load::through_load(const Side& side, const Side& outside, double size) const {
  switch (data_.kind) {
    case LoadKind::orifice: {
      const MassFlow through = orifice_.flow(size, side, outside);
      return {through.value, through.by_first, through.value, through.by_second};
    }
    case LoadKind::laminar: {
      const double density = (side.density + outside.density) / 2;
      const double drop = side.pressure - outside.pressure;
      const double value = size * density * drop;
      return {value, size * (density * side.slope + drop * side.density / side.stiffness / 2),
              value,
              size * (drop * outside.density / outside.stiffness / 2 - density * outside.slope)};
    }
    case LoadKind::relief_valve:
      return through_valve(side, outside, size);
    case LoadKind::flow: {
      const double transition = std::sqrt(orifice_.transition_squared);
      const double share = std::tanh((side.pressure - outside.pressure) / transition);
      const double slope = given_ * size * (1 - share * share) / transition;
      return {given_ * size * share, slope * side.slope, given_ * size * share,
              -slope * outside.slope};
    }
    case LoadKind::constant_pressure:
      break;
  }
  return {};
}

}  // namespace bentaxis::hydraulics

#include "load.h"

#include <algorithm>
#include <limits>

namespace bentaxis::hydraulics {

Load::Load(const LoadData& data, const Orifice& orifice, const Fluid& fluid, double given_mass_flow)
    : data_(data), orifice_(orifice), outside_(fluid.state(0)), given_(given_mass_flow) {}

bool Load::sought() const {
  return data_.kind != LoadKind::constant_pressure && !data_.sets_pressure();
}

double Load::size() const {
  return data_.kind == LoadKind::relief_valve ? data_.cracking_pressure + outside_.pressure : 0;
}

double Load::closed() const {
  return data_.kind == LoadKind::relief_valve ? std::numeric_limits<double>::infinity() : 0;
}

double Load::size_for(double mass_flow, const Side& side) const {
  const double one = orifice_.flow(1, side, outside_).value;
  if (data_.kind == LoadKind::laminar) return mass_flow / flow(side, 1).value;
  if (data_.kind != LoadKind::relief_valve) return mass_flow / one;
  const double area = std::min(mass_flow / one, data_.full_area);
  return std::max(side.pressure - area / data_.opening, outside_.pressure);
}

Load::Flow Load::flow(const Side& side, double size) const {
  switch (data_.kind) {
    case LoadKind::orifice: {
      const MassFlow through = orifice_.flow(size, side, outside_);
      return {through.value, through.by_first, through.value};
    }
    case LoadKind::laminar: {
      const double density = (side.density + outside_.density) / 2;
      const double drop = side.pressure - outside_.pressure;
      const double value = size * density * drop;
      return {value, size * (density * side.slope + drop * side.density / side.stiffness / 2),
              value};
    }
    case LoadKind::relief_valve: {
      const double area = data_.opening * (side.pressure - size);
      if (!(area > 0)) return {};
      if (area >= data_.full_area) {
        const MassFlow full = orifice_.flow(data_.full_area, side, outside_);
        return {full.value, full.by_first, 0};
      }
      const MassFlow through = orifice_.flow(area, side, outside_);
      const double per_pressure = data_.opening * through.value / area;
      return {through.value, through.by_first + per_pressure * side.slope, -per_pressure * size};
    }
    case LoadKind::flow:
      return {given_, 0, 0};
    case LoadKind::constant_pressure:
      break;
  }
  return {};
}

}  // namespace bentaxis::hydraulics

// Flow through an orifice.
#pragma once

#include <cmath>

#include "fluid.h"

namespace bentaxis::hydraulics {

/// Oil on one side of an element.
struct Side {
  double pressure = 0;   ///< Pa absolute
  double slope = 0;      ///< its derivative with respect to the state it belongs to
  double density = 0;    ///< kg/m3
  double stiffness = 0;  ///< d(state)/d(ln density); infinite for a density that is held

  Side(const Fluid::State& at)  // NOLINT(google-explicit-constructor): a fluid's state is one
      : pressure(at.pressure),
        slope(at.pressure),
        density(at.density),
        stiffness(at.density_stiffness) {}
  Side(double at_pressure, double by_state, double at_density, double at_stiffness)
      : pressure(at_pressure), slope(by_state), density(at_density), stiffness(at_stiffness) {}
};

/// Mass flow from side 1 to side 2, kg/s, and its derivatives with respect to the states there.
struct MassFlow {
  double value = 0, by_first = 0, by_second = 0;
};

/// m = Cd a sqrt(2 density) dp/(dp^2 + pcr^2)^(1/4), density the mean of both sides.
struct Orifice {
  double discharge = 0;           ///< Cd
  double transition_squared = 0;  ///< pcr^2, Pa2

  /// The flow alone, as flow() has it to the last bit.
  double value(double area, const Side& first, const Side& second) const {
    if (area == 0) return 0;
    const double drop = first.pressure - second.pressure;
    const double law = drop / std::sqrt(std::sqrt(drop * drop + transition_squared));
    return discharge * area * std::sqrt(first.density + second.density) * law;
  }

  MassFlow flow(double area, const Side& first, const Side& second) const {
    if (area == 0) return {};
    const double drop = first.pressure - second.pressure;
    const double square = drop * drop + transition_squared;
    const double root = std::sqrt(std::sqrt(square));
    const double law = drop / root;
    const double slope = (drop * drop / 2 + transition_squared) / (square * root);
    const double weight = std::sqrt(first.density + second.density);  // sqrt(2 mean density)
    const double by_density = discharge * area * law / (2 * weight);
    return {discharge * area * weight * law,
            discharge * area * weight * slope * first.slope +
                by_density * first.density / first.stiffness,
            -discharge * area * weight * slope * second.slope +
                by_density * second.density / second.stiffness};
  }
};

}  // namespace bentaxis::hydraulics

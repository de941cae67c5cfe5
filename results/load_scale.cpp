#include "bentaxis/results/load_scale.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis {

LoadScale load_scale(const Case& the_case, const Samples& samples) {
  const PumpParameters& pump = the_case.pump;
  const double area = kPi / 4 * pump.geometry.bore_diameter * pump.geometry.bore_diameter;
  double pressure = std::max(std::abs(samples.ports.delivery), std::abs(samples.ports.suction));
  for (const double p : samples.chamber_pressure) pressure = std::max(pressure, std::abs(p));
  const double radius =
      std::max(pump.geometry.joint_circle_radius, pump.geometry.bore_circle_radius);
  const double inertia = pump.piston.mass * samples.omega * samples.omega * radius;
  LoadScale scale;
  scale.force = std::max(
      {pressure * std::max(area, pump.block.bottom_area), pump.block.spring_force,
       pump.friction.piston_coulomb, inertia,
       std::abs(pump.gravity) * std::max({pump.shaft.mass, pump.block.mass, pump.piston.mass})});
  scale.moment =
      std::max({scale.force * radius, pump.friction.block_viscous * std::abs(samples.omega),
                pump.friction.shaft_viscous * std::abs(samples.omega)});
  return scale;
}

}  // namespace bentaxis

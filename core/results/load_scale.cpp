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
  // Half of the plate under pressure; a friction that grows with the speed of the piston.
  const double lands =
      pump.port_plate
          ? kPi / 2 * (std::pow(pump.port_plate->r4, 2) - std::pow(pump.port_plate->r1, 2))
          : 0;
  const double viscous = pump.friction.piston_viscous * std::abs(samples.omega) * radius *
                         std::sin(pump.geometry.tilt);
  const double inertia = pump.piston.mass * samples.omega * samples.omega * radius;
  LoadScale scale;
  scale.force = std::max(
      {pressure * std::max({area, pump.block.bottom_area, lands}), pump.block.spring_force,
       pump.friction.piston_coulomb, viscous, inertia,
       std::abs(pump.gravity) * std::max({pump.shaft.mass, pump.block.mass, pump.piston.mass})});
  scale.moment =
      std::max({scale.force * radius, pump.friction.block_viscous * std::abs(samples.omega),
                pump.friction.shaft_viscous * std::abs(samples.omega)});
  return scale;
}

}  // namespace bentaxis

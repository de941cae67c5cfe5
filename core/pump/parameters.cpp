#include "bentaxis/pump/parameters.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis {

std::string piston_inertia_refusal(PistonInertia inertia, const PumpParameters& pump) {
  if (inertia == PistonInertia::lumped) return "";
  if (!pump.piston.real)
    return "needs centre_of_mass_mm, transverse_inertia_kg_mm2, axial_inertia_kg_mm2 in [piston]";
  const PistonMass::Real& real = *pump.piston.real;
  if (inertia == PistonInertia::dynamically_equivalent && real.transverse_inertia > 0 &&
      !(real.centre_of_mass > 0 && real.centre_of_mass < pump.geometry.piston_length))
    return "needs centre_of_mass_mm between 0 and piston_length_mm (both excluded), where "
           "transverse_inertia_kg_mm2 is not 0";
  return "";
}

AssemblyMargin assembly_margin(const Geometry& g) {
  // With u = cos theta the squared distance of A from its bore axis is
  // (Rd - Ra)^2 (1 - u^2) + (q u - s)^2: its maximum is at u = -1, at u = 1 or at the vertex.
  const double difference = g.bore_circle_radius - g.joint_circle_radius;
  const double q = g.bore_circle_radius - g.joint_circle_radius * std::cos(g.tilt);
  const double s = g.axis_offset * std::sin(g.tilt);
  const auto distance = [&](double u) {
    return std::hypot(difference * std::sqrt(std::max(0.0, 1 - u * u)), q * u - s);
  };
  double worst_u = distance(-1) > distance(1) ? -1 : 1;
  const double curvature = q * q - difference * difference;
  if (curvature < 0) {
    const double vertex = std::clamp(q * s / curvature, -1.0, 1.0);
    if (distance(vertex) > distance(worst_u)) worst_u = vertex;
  }
  return {distance(worst_u), std::acos(worst_u) / kRadPerDegree};
}

double joint_distance(const Geometry& g, double theta, double psi) {
  return std::hypot(g.bore_circle_radius * std::sin(psi) - g.joint_circle_radius * std::sin(theta),
                    g.bore_circle_radius * std::cos(psi) -
                        g.joint_circle_radius * std::cos(g.tilt) * std::cos(theta) -
                        g.axis_offset * std::sin(g.tilt));
}

}  // namespace bentaxis

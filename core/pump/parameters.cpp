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

std::string imposed_refusal(BlockDrive drive, const PumpParameters& pump) {
  if (drive == BlockDrive::mesh || pump.transfer.kind == TransferKind::gear) return "";
  return "must be \"mesh\" beside [transfer] kind = \"" + to_string(pump.transfer.kind) + "\"";
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

// From a.a' = 0 of the joint's arms.
double block_lead(const PumpParameters& pump, double theta) {
  if (!pump.transfer.is_uneven_joint()) return 0;
  const double t = theta - pump.transfer.phase();
  const double c = std::cos(pump.geometry.tilt);
  return std::atan2((c - 1) * std::sin(t) * std::cos(t),
                    std::cos(t) * std::cos(t) + c * std::sin(t) * std::sin(t));
}

AssemblyMargin assembly_margin(const PumpParameters& pump) {
  const Geometry& g = pump.geometry;
  if (!pump.transfer.is_uneven_joint()) return assembly_margin(g);
  // Smooth over the turn: the worst of many angles, and from there the vertex of a parabola.
  constexpr int kAngles = 3600;
  const double step = 2 * kPi / kAngles;
  AssemblyMargin worst;
  for (int k = 0; k < g.pistons; ++k) {
    const double phase = 2 * kPi * k / g.pistons;
    const auto distance = [&](double theta) {
      return joint_distance(g, theta - phase, theta + block_lead(pump, theta) - phase);
    };
    const auto take = [&](double theta, double value) {
      if (value > worst.longest_distance) worst = {value, theta / kRadPerDegree};
    };
    double before = distance(-step), here = distance(0);
    for (int i = 0; i < kAngles; ++i) {
      const double next = distance(step * (i + 1));
      const double bend = before - 2 * here + next;
      if (here >= before && here >= next && bend < 0) {
        const double vertex = step * (i + (before - next) / (2 * bend));
        take(vertex, std::max(here, distance(vertex)));
      }
      before = here;
      here = next;
    }
    take(0, distance(0));
  }
  return worst;
}

double joint_distance(const Geometry& g, double theta, double psi) {
  return std::hypot(g.bore_circle_radius * std::sin(psi) - g.joint_circle_radius * std::sin(theta),
                    g.bore_circle_radius * std::cos(psi) -
                        g.joint_circle_radius * std::cos(g.tilt) * std::cos(theta) -
                        g.axis_offset * std::sin(g.tilt));
}

}  // namespace bentaxis

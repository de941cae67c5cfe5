#include "scene/piston.h"

#include <string>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "scene/mass_properties.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::Transform;
using SimTK::Vec3;

namespace {

// A point mass on a piston's axis, from A.
struct PointMass {
  double mass = 0;
  double z = 0;
};

// Masses at A, at the centre of mass and at B with the real piston's mass, centre and transverse
// inertia: the middle one is what the outer two, with their common centre there, leave over.
std::vector<PointMass> three_point_masses(const PistonMass& piston, double length) {
  const auto& real = *piston.real;
  const double from_a = real.centre_of_mass;
  const double outer =
      real.transverse_inertia > 0 ? real.transverse_inertia / (from_a * (length - from_a)) : 0;
  return {{outer * (length - from_a) / length, 0},
          {piston.mass - outer, from_a},
          {outer * from_a / length, length}};
}

PistonBody lumped_body(const PistonMass& mass, double length) {
  const double at_ring = (1 - mass.joint_mass_fraction) * mass.mass;
  return {symmetric_body(mass.mass, (1 - mass.joint_mass_fraction) * length,
                         at_ring * length * length, 0),
          false};
}

PistonBody three_mass_body(const PistonMass& mass, double length) {
  double about_joint = 0;
  double moment = 0;
  for (const PointMass& point : three_point_masses(mass, length)) {
    moment += point.mass * point.z;
    about_joint += point.mass * point.z * point.z;
  }
  return {symmetric_body(mass.mass, mass.mass > 0 ? moment / mass.mass : 0, about_joint, 0), false};
}

PistonBody rigid_body(const PistonMass& mass) {
  const PistonMass::Real& real = *mass.real;
  return {symmetric_body(
              mass.mass, real.centre_of_mass,
              real.transverse_inertia + mass.mass * real.centre_of_mass * real.centre_of_mass,
              real.axial_inertia),
          real.axial_inertia > 0};
}

}  // namespace

PistonBody piston_body(const PumpParameters& pump, PistonInertia inertia) {
  const PistonMass& mass = pump.piston;
  if (inertia == PistonInertia::lumped) return lumped_body(mass, pump.geometry.piston_length);
  if (mass.mass == 0 && mass.real && mass.real->transverse_inertia > 0)  // axial <= 2 transverse
    throw ComputationError(
        "multibody model: a piston with inertia (transverse_ or axial_inertia_kg_mm2) but without "
        "mass (mass_kg = 0) is not a body in Simbody; use the analytic model");
  if (const std::string why = piston_inertia_refusal(inertia, pump); !why.empty())
    throw InputError(to_string(inertia) + " pistons: " + why);
  return inertia == PistonInertia::real ? rigid_body(mass)
                                        : three_mass_body(mass, pump.geometry.piston_length);
}

bool has_equation_of_motion(const PumpParameters& pump, PistonInertia inertia) {
  return piston_body(pump, inertia).inertia_about_joint() > 0;
}

Pistons add_pistons(const Geometry& geometry, const PistonBody& piston, MobilizedBody& shaft,
                    MobilizedBody& block) {
  Pistons pistons;
  for (int k = 0; k < geometry.pistons; ++k) {
    const Rotation phase(-2 * kPi * k / geometry.pistons, SimTK::ZAxis);
    const Vec3 joint = phase * Vec3(0, geometry.joint_circle_radius, 0);
    const Vec3 bore = phase * Vec3(0, geometry.bore_circle_radius, 0);
    const SimTK::Body::Rigid body(piston.properties);
    MobilizedBody on_shaft;
    if (piston.free_to_spin)
      on_shaft = MobilizedBody::Ball(shaft, Transform(joint), body, Transform());
    else
      on_shaft = MobilizedBody::LineOrientation(shaft, Transform(joint), body, Transform());
    pistons.joint_points.push_back(joint);
    pistons.bore_points.push_back(bore);
    pistons.bodies.push_back(on_shaft);
  }
  const SimTK::UnitVec3 axis(SimTK::ZAxis);
  pistons.all_bores.emplace(block, axis, pistons.bore_points, pistons.bodies,
                            Vec3(0, 0, geometry.piston_length));
  for (int k = 0; k < geometry.pistons; ++k)
    pistons.bores.emplace_back(*pistons.all_bores, 2 * k, axis);
  return pistons;
}

double piston_power(const PumpParameters& pump, PistonInertia inertia, const MobilizedBody& piston,
                    const SimTK::State& state, const SpatialVec& acceleration,
                    const SpatialVec& rate) {
  const PistonMass& mass = pump.piston;
  const Vec3 gravity(0, -pump.gravity, 0);
  const Vec3 axis(piston.getBodyRotation(state).z());
  const Vec3& w = piston.getBodyAngularVelocity(state);
  double power = 0;
  const auto add_mass = [&](double part, double z) {
    const Vec3 r = z * axis;
    const Vec3 velocity = rate[1] + rate[0] % r;
    const Vec3 point = acceleration[1] + acceleration[0] % r + w % (w % r);
    power += part * dot(gravity - point, velocity);
  };
  if (inertia == PistonInertia::lumped) {
    add_mass(mass.joint_mass_fraction * mass.mass, 0);
    add_mass((1 - mass.joint_mass_fraction) * mass.mass, pump.geometry.piston_length);
    return power;
  }
  add_mass(mass.mass, mass.real->centre_of_mass);
  const double it = mass.real->transverse_inertia;
  const double ia = inertia == PistonInertia::real ? mass.real->axial_inertia : 0;
  const auto inertia_times = [&](const Vec3& v) {
    return Vec3(it * v + (ia - it) * dot(axis, v) * axis);
  };
  return power - dot(inertia_times(acceleration[0]) + w % inertia_times(w), rate[0]);
}

}  // namespace bentaxis::multibody

#include "bentaxis/multibody/reactions.h"

#include <cmath>

#include "bentaxis/multibody/conventions.h"
#include "bentaxis/pump/result_table.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::UnitVec3;
using SimTK::Vec3;

namespace {

// A piston's point masses (lumped) or rigid body (real): d/dt of kinetic energy along the
// velocities of `rate`, and the power of its weight.
struct BodyPower {
  double kinetic = 0;
  double weight = 0;
};

BodyPower piston_power(const PumpSystem& pump, const MobilizedBody& piston, const State& state,
                       const State& rate) {
  const PumpParameters& p = pump.pump();
  const Vec3 gravity(0, -p.gravity, 0);
  BodyPower power;
  const auto add_mass = [&](double mass, double z) {
    const Vec3 station(0, 0, z);
    const Vec3 velocity = piston.findStationVelocityInGround(rate, station);
    power.kinetic += mass * dot(piston.findStationAccelerationInGround(state, station), velocity);
    power.weight += mass * dot(gravity, velocity);
  };
  if (pump.assumptions().inertia == PistonInertia::lumped) {
    add_mass(p.piston.joint_mass_fraction * p.piston.mass, 0);
    add_mass((1 - p.piston.joint_mass_fraction) * p.piston.mass, p.geometry.piston_length);
  } else {
    add_mass(p.piston.mass, p.piston.real->centre_of_mass);
    const double it = p.piston.real->transverse_inertia;
    const double ia = p.piston.real->axial_inertia;
    const Vec3 axis(piston.getBodyRotation(state).z());
    const auto inertia_times = [&](const Vec3& v) {
      return Vec3(it * v + (ia - it) * dot(axis, v) * axis);
    };
    const Vec3 w = piston.getBodyAngularVelocity(state);
    const Vec3 momentum_rate =
        inertia_times(piston.getBodyAngularAcceleration(state)) + w % inertia_times(w);
    power.kinetic += dot(momentum_rate, piston.getBodyAngularVelocity(rate));
  }
  return power;
}

// Moment that all forces on a piston leave about its own axis: what changes its spin.
double moment_about_axis(const PumpSystem& pump, const MobilizedBody& piston,
                         const SpatialVec& joint, const State& state) {
  const UnitVec3 axis = piston.getBodyRotation(state).z();
  double moment = dot(joint[0], Vec3(axis));
  if (pump.assumptions().inertia == PistonInertia::real) {
    const auto& real = *pump.pump().piston.real;
    moment -= real.axial_inertia * dot(piston.getBodyAngularAcceleration(state), Vec3(axis));
    if (real.axial_inertia == 0) moment = dot(joint[0], Vec3(axis));
  }
  return moment;
}

}  // namespace

void read_channels(const PumpSystem& pump, const State& state, const WorkRate& rate,
                   double omega_dot, const std::vector<double>& pressure, const ChannelLayout& at,
                   std::vector<double>& values) {
  const PumpBodies& bodies = pump.bodies();
  const PumpParameters& p = pump.pump();
  const SimTK::Rotation& s2 = bodies.block_frame;
  SimTK::Vector_<SpatialVec> joints;
  joint_forces(state, pump.matter(), joints);

  const double omega = state.getU()[bodies.shaft.getFirstUIndex(state) + 2];
  double carry = 0;
  double work = 0;
  for (int k = 0; k < at.pistons(); ++k) {
    const MobilizedBody& piston = bodies.pistons[k];
    const SpatialVec& joint = joints[piston.getMobilizedBodyIndex()];
    const SpatialVec bore = constraint_force_on(state, pump.bores()[k], piston);
    const Vec3 rs = ~s2 * joint[1];
    const Vec3 rc = ~s2 * bore[1];
    for (int axis = 0; axis < 3; ++axis) values[at.Rs(k, axis)] = rs[axis];
    for (int axis = 0; axis < 2; ++axis) values[at.Rc(k, axis)] = rc[axis];

    const Vec3 ring_station(0, 0, p.geometry.piston_length);
    const Vec3 ring =
        ~s2 * (piston.findStationLocationInGround(state, ring_station) - bodies.block_origin);
    values[at.pressure(k)] = pressure[k];
    values[at.zB(k)] = ring[2];
    const double share = ring[1] * rc[0] - ring[0] * rc[1];
    values[at.Tc(k)] = share;
    carry -= share;

    // S3 with j3 in the plane of y1 and z1 (15).
    const UnitVec3 k3 = piston.getBodyRotation(state).z();
    const UnitVec3 j3(Vec3(0, k3[2], -k3[1]));
    values[at.Rs3(k, 0)] = dot(joint[1], Vec3(j3 % k3));
    values[at.Rs3(k, 1)] = dot(joint[1], Vec3(j3));
    values[at.Rs3(k, 2)] = dot(joint[1], Vec3(k3));

    const double velocity =
        dot(Vec3(s2.z()), piston.findStationVelocityInGround(state, ring_station));
    const AxialLoad load =
        axial_load(p, pump.assumptions(), pressure[k], velocity, pump.inputs().rest_speed);
    const double axial_rate =
        dot(Vec3(s2.z()), piston.findStationVelocityInGround(rate.state, ring_station));
    const BodyPower power = piston_power(pump, piston, state, rate.state);
    work += (load.pressure + load.friction) * axial_rate + power.weight - power.kinetic;
    values[at.axis_moment(k)] = moment_about_axis(pump, piston, joint, state);
  }

  // The block's joint to ground stands for film and pin together: Rcn is what it takes across z2,
  // and the moment about O2 that is left belongs to the film.
  const SpatialVec& hold = joints[bodies.block.getMobilizedBodyIndex()];
  const Vec3 force = ~s2 * hold[1];
  const Vec3 moment = ~s2 * hold[0];
  values[at.Fh()] = force[2];
  values[at.Rcn(0)] = force[0];
  values[at.Rcn(1)] = force[1];
  values[at.Th(0)] = moment[0] + p.block.pin_z * force[1];
  values[at.Th(1)] = moment[1] - p.block.pin_z * force[0];
  values[at.xh()] = force[2] == 0 ? not_computed() : -values[at.Th(1)] / force[2];
  values[at.yh()] = force[2] == 0 ? not_computed() : values[at.Th(0)] / force[2];
  if (pump.has_gear()) {
    values[at.Rcs()] = pump.gear().tooth_force(state);
    values[at.Tcs()] = carry + p.friction.block_viscous * omega + p.block.axial_inertia * omega_dot;
  } else {
    values[at.Rcs()] = not_computed();
    values[at.Tcs()] = pump.imposed_block_torque(state);
  }

  const SpatialVec& tapered = joints[bodies.shaft.getMobilizedBodyIndex()];
  const SpatialVec cylindrical =
      constraint_force_on(state, pump.cylindrical_bearing(), bodies.shaft);
  for (int axis = 0; axis < 3; ++axis) values[at.Rb1(axis)] = tapered[1][axis];
  for (int axis = 0; axis < 2; ++axis) values[at.Rb2(axis)] = cylindrical[1][axis];
  // The drive constraint gives the torque that is left after the proportional loss (38).
  const double net = pump.drive_torque(state);
  values[at.Td()] = net / p.friction.shaft_torque_factor;

  values[at.power_residual()] = net -
                                (p.friction.shaft_viscous + p.friction.block_viscous) * omega -
                                (p.shaft.axial_inertia + p.block.axial_inertia) * omega_dot +
                                work / rate.omega + (pump.has_gear() ? 0 : values[at.Tcs()]);
}

}  // namespace bentaxis::multibody

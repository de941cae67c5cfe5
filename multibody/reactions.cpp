#include "reactions.h"

#include <cmath>

#include "bentaxis/results/result_table.h"
#include "conventions.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::UnitVec3;
using SimTK::Vec3;

namespace {

// Power of a piston's inertia and weight along the velocities of `rate`, W: its point masses
// (lumped, dynamically equivalent) or rigid body (real).
double piston_power(const PumpSystem& pump, const MobilizedBody& piston, const State& state,
                    const SpatialVec& acceleration, const SpatialVec& rate) {
  const PumpParameters& p = pump.pump();
  const Vec3 gravity(0, -p.gravity, 0);
  const Vec3 axis(piston.getBodyRotation(state).z());
  const Vec3& w = piston.getBodyAngularVelocity(state);
  double power = 0;
  const auto add_mass = [&](double mass, double z) {
    const Vec3 r = z * axis;
    const Vec3 velocity = rate[1] + rate[0] % r;
    const Vec3 point = acceleration[1] + acceleration[0] % r + w % (w % r);
    power += mass * dot(gravity - point, velocity);
  };
  if (pump.assumptions().inertia == PistonInertia::lumped) {
    add_mass(p.piston.joint_mass_fraction * p.piston.mass, 0);
    add_mass((1 - p.piston.joint_mass_fraction) * p.piston.mass, p.geometry.piston_length);
  } else {
    add_mass(p.piston.mass, p.piston.real->centre_of_mass);
    const bool rigid = pump.assumptions().inertia == PistonInertia::real;
    const double it = p.piston.real->transverse_inertia;
    const double ia = rigid ? p.piston.real->axial_inertia : 0;
    const auto inertia_times = [&](const Vec3& v) {
      return Vec3(it * v + (ia - it) * dot(axis, v) * axis);
    };
    power -= dot(inertia_times(acceleration[0]) + w % inertia_times(w), rate[0]);
  }
  return power;
}

}  // namespace

void reactions_from_multipliers(const PumpSystem& pump, const State& state, Reactions& reactions) {
  const PumpBodies& bodies = pump.bodies();
  SimTK::Vector_<SpatialVec> joints;
  joint_forces(state, pump.matter(), joints);
  const Rotation& block = bodies.block.getBodyRotation(state);
  reactions.pistons.resize(bodies.pistons.size());
  for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
    const MobilizedBody& piston = bodies.pistons[k];
    Reactions::OnPiston& on = reactions.pistons[k];
    const SpatialVec& joint = joints[piston.getMobilizedBodyIndex()];
    on.joint = joint[1];
    on.bore = block * pump.bores()[k].force_in_base(state);
    on.acceleration = piston.getBodyAcceleration(state);
    // Where the joint leaves the spin free, a moment about the axis would change it.
    on.place = piston.getBodyTransform(state);
    const Vec3 axis(on.place.z());
    on.axis_moment = dot(joint[0], axis);
    if (pump.pistons_free_to_spin())
      on.axis_moment -= pump.pump().piston.real->axial_inertia * dot(on.acceleration[0], axis);
  }
  if (pump.is_prescribed()) return;
  reactions.block_hold = joints[bodies.block.getMobilizedBodyIndex()];
  reactions.tapered = joints[bodies.shaft.getMobilizedBodyIndex()][1];
  reactions.cylindrical = pump.cylindrical_bearing().force_in_base(state);
  reactions.drive = pump.drive_torque(state);
  if (pump.has_gear())
    reactions.tooth = pump.gear().tooth_force(state);
  else
    reactions.imposed = pump.imposed_block_torque(state);
}

SpatialVec ResidualSolver::needed(const MobilizedBody& body, const Loads& loads) const {
  const State& state = pump_.dynamics();
  const SimTK::MobilizedBodyIndex index = body.getMobilizedBodyIndex();
  const SpatialVec inertia = body.getBodySpatialInertiaInGround(state) * accelerations_[index] +
                             pump_.matter().getGyroscopicForce(state, index);
  return inertia - loads[index];
}

void ResidualSolver::solve(Reactions& reactions) {
  const State& state = pump_.dynamics();
  const SimTK::SimbodyMatterSubsystem& matter = pump_.matter();
  const PumpBodies& bodies = pump_.bodies();
  pump_.system().realize(state, SimTK::Stage::Dynamics);
  const Loads& loads = pump_.system().getRigidBodyForces(state, SimTK::Stage::Dynamics);
  pump_.constrained_accelerations(udot_);
  matter.calcResidualForceIgnoringConstraints(
      state, pump_.system().getMobilityForces(state, SimTK::Stage::Dynamics), loads, udot_,
      residual_);
  matter.calcBodyAccelerationFromUDot(state, udot_, accelerations_);
  pump_.piston_solver().solve_forces(residual_, bore_);

  const Rotation& block = bodies.block.getBodyRotation(state);
  reactions.pistons.resize(bodies.pistons.size());
  for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
    const MobilizedBody& piston = bodies.pistons[k];
    Reactions::OnPiston& on = reactions.pistons[k];
    on.acceleration = accelerations_[piston.getMobilizedBodyIndex()];
    on.place = piston.getBodyTransform(state);
    on.bore = block * pump_.bores()[k].force_in_base(bore_[k][0], bore_[k][1]);
    const SpatialVec total = needed(piston, loads);
    on.joint = total[1] - on.bore;
    // B is on the axis through A: the bore force has no moment about it.
    on.axis_moment = dot(total[0], Vec3(on.place.z()));
  }
  if (!pump_.is_prescribed()) solve_block_and_shaft(reactions, loads);
}

void ResidualSolver::solve_block_and_shaft(Reactions& reactions, const Loads& loads) {
  const State& state = pump_.dynamics();
  const PumpBodies& bodies = pump_.bodies();
  const Vec3& c1 = bodies.shaft_origin;
  const Vec3& o2 = bodies.block_origin;
  const Vec3 z2(bodies.block_frame.z());

  // Block: what it needs beyond the bores' forces is supplied by the gear (or the imposed motion)
  // about z2 and held by film and pin in all other directions.
  const Vec3& block_at = bodies.block.getBodyOriginLocation(state);
  SpatialVec hold = needed(bodies.block, loads);
  hold[0] += (block_at - o2) % hold[1];
  SpatialVec on_shaft = needed(bodies.shaft, loads);
  on_shaft[0] += (bodies.shaft.getBodyOriginLocation(state) - c1) % on_shaft[1];
  for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
    const Reactions::OnPiston& on = reactions.pistons[k];
    const Vec3 ring = on.place.p() + pump_.pump().geometry.piston_length * Vec3(on.place.z());
    hold += SpatialVec((ring - o2) % on.bore, on.bore);
    on_shaft += SpatialVec((on.place.p() - c1) % on.joint, on.joint);
  }
  if (pump_.has_gear()) {
    const Vec3& line = pump_.gear().line();
    const Vec3 on_block = (pump_.gear().point() - o2) % line;
    reactions.tooth = dot(hold[0], z2) / dot(on_block, z2);
    const Vec3 tooth = reactions.tooth * line;
    hold -= SpatialVec((pump_.gear().point() - o2) % tooth, tooth);
    on_shaft += SpatialVec((pump_.gear().point() - c1) % tooth, tooth);
  } else {
    reactions.imposed = dot(hold[0], z2);
    hold[0] -= reactions.imposed * z2;
  }
  reactions.block_hold = hold;
  // Shaft: forces at C1 and C2 (across z1 there) and a torque about z1.
  const double distance = pump_.pump().bearings.cylindrical_z - pump_.pump().bearings.tapered_z;
  reactions.cylindrical = Vec3(on_shaft[0][1] / distance, -on_shaft[0][0] / distance, 0);
  reactions.tapered = on_shaft[1] - reactions.cylindrical;
  reactions.drive = on_shaft[0][2];
}

void read_piston_channels(const PumpSystem& pump, const Reactions& reactions, std::size_t index,
                          int channel, double pressure, const ChannelLayout& layout,
                          std::vector<double>& values) {
  const PumpBodies& bodies = pump.bodies();
  const Rotation& s2 = bodies.block_frame;
  const Reactions::OnPiston& on = reactions.pistons[index];
  const Vec3 rs = ~s2 * on.joint;
  const Vec3 rc = ~s2 * on.bore;
  for (int axis = 0; axis < 3; ++axis) values[layout.Rs(channel, axis)] = rs[axis];
  for (int axis = 0; axis < 2; ++axis) values[layout.Rc(channel, axis)] = rc[axis];

  const Vec3 k3(on.place.z());
  const Vec3 ring =
      ~s2 * Vec3(on.place.p() + pump.pump().geometry.piston_length * k3 - bodies.block_origin);
  values[layout.pressure(channel)] = pressure;
  values[layout.zB(channel)] = ring[2];
  values[layout.Tc(channel)] = ring[1] * rc[0] - ring[0] * rc[1];

  // S3 with j3 in the plane of y1 and z1 (15).
  const UnitVec3 j3(Vec3(0, k3[2], -k3[1]));
  values[layout.Rs3(channel, 0)] = dot(on.joint, Vec3(Vec3(j3) % k3));
  values[layout.Rs3(channel, 1)] = dot(on.joint, Vec3(j3));
  values[layout.Rs3(channel, 2)] = dot(on.joint, k3);
  values[layout.axis_moment(channel)] = on.axis_moment;
}

void read_pump_channels(const PumpSystem& pump, const State& state, const Reactions& reactions,
                        const WorkRate& rate, double omega_dot, const std::vector<double>& pressure,
                        const ChannelLayout& layout, std::vector<double>& values) {
  const PumpBodies& bodies = pump.bodies();
  const PumpParameters& p = pump.pump();
  const Rotation& s2 = bodies.block_frame;
  const Vec3 z2(s2.z());
  const double omega = state.getU()[bodies.shaft.getFirstUIndex(state) + 2];
  double carry = 0;
  double work = 0;
  for (int k = 0; k < layout.pistons(); ++k) {
    const MobilizedBody& piston = bodies.pistons[k];
    carry -= values[layout.Tc(k)];
    const Vec3 ring = p.geometry.piston_length * Vec3(piston.getBodyRotation(state).z());
    const SpatialVec& own_rate = piston.getBodyVelocity(state);
    const SpatialVec& work_rate = piston.getBodyVelocity(rate.state);
    const double velocity = dot(z2, own_rate[1] + own_rate[0] % ring);
    const AxialLoad load =
        axial_load(p, pump.assumptions(), pressure[k], velocity, pump.inputs().rest_speed);
    work += (load.pressure + load.friction) * dot(z2, work_rate[1] + work_rate[0] % ring) +
            piston_power(pump, piston, state, reactions.pistons[k].acceleration, work_rate);
  }

  // The block's joint to ground stands for film and pin together: Rcn is what it takes across z2,
  // and the moment about O2 that is left belongs to the film.
  const Vec3 force = ~s2 * reactions.block_hold[1];
  const Vec3 moment = ~s2 * reactions.block_hold[0];
  values[layout.Fh()] = force[2];
  values[layout.Rcn(0)] = force[0];
  values[layout.Rcn(1)] = force[1];
  values[layout.Th(0)] = moment[0] + p.block.pin_z * force[1];
  values[layout.Th(1)] = moment[1] - p.block.pin_z * force[0];
  values[layout.xh()] = force[2] == 0 ? not_computed() : -values[layout.Th(1)] / force[2];
  values[layout.yh()] = force[2] == 0 ? not_computed() : values[layout.Th(0)] / force[2];
  if (pump.has_gear()) {
    values[layout.Rcs()] = reactions.tooth;
    values[layout.Tcs()] =
        carry + p.friction.block_viscous * omega + p.block.axial_inertia * omega_dot;
  } else {
    values[layout.Rcs()] = not_computed();
    values[layout.Tcs()] = reactions.imposed;
  }
  for (int axis = 0; axis < 3; ++axis) values[layout.Rb1(axis)] = reactions.tapered[axis];
  for (int axis = 0; axis < 2; ++axis) values[layout.Rb2(axis)] = reactions.cylindrical[axis];
  // The drive gives the torque that is left after the proportional loss (38).
  values[layout.Td()] = reactions.drive / p.friction.shaft_torque_factor;

  values[layout.power_residual()] =
      reactions.drive - (p.friction.shaft_viscous + p.friction.block_viscous) * omega -
      (p.shaft.axial_inertia + p.block.axial_inertia) * omega_dot + work / rate.omega +
      (pump.has_gear() ? 0 : values[layout.Tcs()]);
}

void read_channels(const PumpSystem& pump, const State& state, const WorkRate& rate,
                   double omega_dot, const std::vector<double>& pressure,
                   const ChannelLayout& layout, std::vector<double>& values) {
  Reactions reactions;
  reactions_from_multipliers(pump, state, reactions);
  for (int k = 0; k < layout.pistons(); ++k)
    read_piston_channels(pump, reactions, k, k, pressure[k], layout, values);
  read_pump_channels(pump, state, reactions, rate, omega_dot, pressure, layout, values);
}

}  // namespace bentaxis::multibody

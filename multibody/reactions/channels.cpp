#include "reactions/channels.h"

#include "bentaxis/results/result_table.h"
#include "reactions/motion_checks.h"
#include "scene/piston.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::UnitVec3;
using SimTK::Vec3;

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
  const auto on_axis = [&](double length) {
    return Vec3(~s2 * Vec3(on.place.p() + length * k3 - bodies.block_origin));
  };
  const Vec3 ring = on_axis(pump.pump().geometry.piston_length);
  const Vec3 contact = on_axis(pump.contact_length());
  values[layout.pressure(channel)] = pressure;
  values[layout.zB(channel)] = ring[2];
  values[layout.Tc(channel)] = contact[1] * rc[0] - contact[0] * rc[1];

  // S3 with j3 in the plane of y1 and z1 (15).
  const UnitVec3 j3(Vec3(0, k3[2], -k3[1]));
  values[layout.Rs3(channel, 0)] = dot(on.joint, Vec3(Vec3(j3) % k3));
  values[layout.Rs3(channel, 1)] = dot(on.joint, Vec3(j3));
  values[layout.Rs3(channel, 2)] = dot(on.joint, k3);
  values[layout.axis_moment(channel)] = on.axis_moment;
}

namespace {

// Both torques that pass between shaft and block, Nm, where the block is locked to the shaft and a
// gear or an imposed motion turns it: those of a gear with one line cancel.
double gear_torque(const PumpSystem& pump, const State& state, const Reactions& reactions,
                   double imposed) {
  if (!pump.has_gear()) return imposed;
  if (pump.bevel() == nullptr) return 0;
  return reactions.tooth * pump.gear().arm() + pump.bevel_torque_on_shaft(state);
}

// What transfers other than a gear have.
void read_transfer_channels(const PumpSystem& pump, const Reactions& reactions,
                            const AxisMotions& motion, const ChannelLayout& layout,
                            std::vector<double>& values) {
  const Rotation& s2 = pump.bodies().block_frame;
  if (layout.has(Quantity::TcsJoint)) {
    const Vec3 couple = ~s2 * reactions.couple;
    for (int axis = 0; axis < 3; ++axis) values[layout.TcsJoint(axis)] = couple[axis];
  }
  if (layout.has(Quantity::Fcs)) {
    const Vec3 force = ~s2 * reactions.side_force;
    for (int axis = 0; axis < 3; ++axis) values[layout.Fcs(axis)] = force[axis];
  }
  if (layout.has(Quantity::psi)) values[layout.psi()] = motion.block.angle;
  if (layout.has(Quantity::psi_speed)) values[layout.psi_speed()] = motion.block.speed;
  if (layout.has(Quantity::psi_acceleration))
    values[layout.psi_acceleration()] = motion.block.acceleration;
  if (!layout.has(Quantity::Rw)) return;
  for (int k = 0; k < layout.pistons(); ++k) {
    const Vec3 wall = ~s2 * reactions.pistons[k].wall;
    for (int axis = 0; axis < 2; ++axis) values[layout.Rw(k, axis)] = wall[axis];
  }
  values[layout.lag()] = motion.shaft.angle - motion.block.angle;
  values[layout.Tb()] = pump.block_is_imposed() ? reactions.imposed : not_computed();
}

}  // namespace

void read_pump_channels(const PumpSystem& pump, const State& state, const Reactions& reactions,
                        const WorkRate& rate, const AxisMotions& motion,
                        const std::vector<double>& pressure, const ChannelLayout& layout,
                        std::vector<double>& values) {
  const PumpBodies& bodies = pump.bodies();
  const PumpParameters& p = pump.pump();
  const Rotation& s2 = bodies.block_frame;
  const Vec3 z2(s2.z());
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
            piston_power(p, pump.assumptions().inertia, piston, state,
                         reactions.pistons[k].acceleration, work_rate);
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
  if (!layout.has(Quantity::Tcs)) {
    values[layout.Rcs()] = not_computed();
    read_transfer_channels(pump, reactions, motion, layout, values);
  } else if (pump.has_gear()) {
    values[layout.Rcs()] = tooth_force_column(pump, reactions.tooth, motion.shaft.speed);
    values[layout.Tcs()] = carry + p.friction.block_viscous * motion.block.speed +
                           p.block.axial_inertia * motion.block.acceleration;
  } else {
    values[layout.Rcs()] = not_computed();
    values[layout.Tcs()] = reactions.imposed;
  }
  for (int axis = 0; axis < 3; ++axis) values[layout.Rb1(axis)] = reactions.tapered[axis];
  for (int axis = 0; axis < 2; ++axis) values[layout.Rb2(axis)] = reactions.cylindrical[axis];
  // The drive gives the torque that is left after the proportional loss (38).
  values[layout.Td()] = reactions.drive / p.friction.shaft_torque_factor;

  if (!motion.locked() || !layout.has(Quantity::Tcs)) return;
  work += ring_power(pump, reactions, rate.state);
  values[layout.power_residual()] =
      reactions.drive - (p.friction.shaft_viscous + p.friction.block_viscous) * motion.shaft.speed -
      (p.shaft.axial_inertia + p.block.axial_inertia) * motion.shaft.acceleration +
      work / rate.omega + gear_torque(pump, state, reactions, values[layout.Tcs()]);
}

void read_channels(const PumpSystem& pump, const State& state, const WorkRate& rate,
                   const AxisMotions& motion, const std::vector<double>& pressure,
                   const ChannelLayout& layout, std::vector<double>& values) {
  Reactions reactions;
  reactions_from_multipliers(pump, state, reactions);
  for (int k = 0; k < layout.pistons(); ++k)
    read_piston_channels(pump, reactions, k, k, pressure[k], layout, values);
  read_pump_channels(pump, state, reactions, rate, motion, pressure, layout, values);
}

void read_motion_row(const PumpSystem& pump, const State& state, const AxisMotions& motion,
                     const std::vector<double>& pressure, const ChannelLayout& layout,
                     std::vector<double>& values, MotionChecks& checks) {
  Reactions reactions;
  reactions_from_multipliers(pump, state, reactions);
  for (int k = 0; k < layout.pistons(); ++k)
    read_piston_channels(pump, reactions, k, k, pressure[k], layout, values);
  const double speed = motion.shaft.speed;
  read_pump_channels(pump, state, reactions, {state, speed}, motion, pressure, layout, values);
  const bool is_compliant = pump.teeth() != nullptr || pump.bevel() != nullptr;
  checks = {is_compliant ? reactions.tooth : not_computed(), ring_power(pump, reactions, state),
            power_balance(pump, state, reactions, state.getUDot())};
  values[layout.power_residual()] = speed == 0 ? not_computed() : checks.power_balance / speed;
}

}  // namespace bentaxis::multibody

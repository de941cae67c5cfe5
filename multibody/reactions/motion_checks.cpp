#include "reactions/motion_checks.h"

#include <cmath>

#include "bentaxis/results/result_table.h"
#include "scene/tooth_contact.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

namespace {

// Velocity of a body's material that passes a point of space.
Vec3 velocity_at(const State& state, const MobilizedBody& body, const Vec3& point) {
  const SpatialVec& rate = body.getBodyVelocity(state);
  return rate[1] + rate[0] % (point - body.getBodyOriginLocation(state));
}

// Of the shaft's teeth past the block's at the mesh point.
Vec3 sliding_at_mesh(const PumpSystem& pump, const State& state) {
  const Vec3& point = pump.gear().point();
  return velocity_at(state, pump.bodies().shaft, point) -
         velocity_at(state, pump.bodies().block, point);
}

double power(const SpatialVec& force, const SpatialVec& rate) {
  return dot(force[0], rate[0]) + dot(force[1], rate[1]);
}

}  // namespace

double tooth_force_column(const PumpSystem& pump, double tooth, double shaft_speed) {
  const double towards_psi = pump.gear().arm() < 0 ? -1 : 1;
  const double direction = shaft_speed < 0 ? -1 : 1;
  return direction * towards_psi * tooth;
}

double ring_power(const PumpSystem& pump, const Reactions& reactions, const State& rate) {
  if (pump.contact_at_b()) return 0;
  double power = 0;
  for (std::size_t k = 0; k < pump.bodies().pistons.size(); ++k) {
    const Reactions::OnPiston& on = reactions.pistons[k];
    const Vec3 contact = on.place.p() + pump.contact_length() * Vec3(on.place.z());
    power += dot(on.bore, velocity_at(rate, pump.bodies().pistons[k], contact) -
                              velocity_at(rate, pump.bodies().block, contact));
  }
  return power;
}

double power_balance(const PumpSystem& pump, const State& state, const Reactions& reactions,
                     const SimTK::Vector& udot) {
  const SimTK::SimbodyMatterSubsystem& matter = pump.matter();
  const PumpBodies& bodies = pump.bodies();
  const auto& loads = pump.system().getRigidBodyForces(state, SimTK::Stage::Dynamics);
  SimTK::Vector_<SpatialVec> accelerations;
  matter.calcBodyAccelerationFromUDot(state, udot, accelerations);
  double sum = 0;
  for (SimTK::MobilizedBodyIndex i(1); i < matter.getNumBodies(); ++i) {
    const MobilizedBody& body = matter.getMobilizedBody(i);
    const SpatialVec inertia = body.getBodySpatialInertiaInGround(state) * accelerations[i] +
                               matter.getGyroscopicForce(state, i);
    sum += power(loads[i] - inertia, body.getBodyVelocity(state));
  }
  // What is no applied force.
  if (pump.drive().has_equation())
    sum += reactions.drive * bodies.shaft.getBodyAngularVelocity(state)[2];
  if (pump.has_rigid_gear())
    sum -= reactions.tooth * dot(reactions.tooth_line, sliding_at_mesh(pump, state));
  else if (pump.joint() != nullptr)
    sum += dot(reactions.couple, bodies.block.getBodyAngularVelocity(state) -
                                     bodies.shaft.getBodyAngularVelocity(state)) +
           dot(reactions.side_force, velocity_at(state, bodies.block, bodies.block_origin) -
                                         velocity_at(state, bodies.shaft, bodies.block_origin));
  else if (pump.block_is_imposed())
    sum += reactions.imposed * bodies.block.getOneU(state, 0);
  return sum + ring_power(pump, reactions, state);
}

double contact_law_force(const PumpSystem& pump, const State& state, double lag) {
  if (pump.bevel() != nullptr)
    return pump.bevel_torque_on_block(state) / std::abs(pump.gear().arm());
  const auto& teeth = pump.pump().gear.compliance;
  if (!teeth || pump.pump().gear.contact != ToothContact::compliant || !pump.has_gear())
    return not_computed();
  const double towards_psi = pump.gear().arm() < 0 ? -1 : 1;
  const Vec3 line = towards_psi * pump.gear().line_for(towards_psi);
  return tooth_force(*teeth, towards_psi * pump.gear().arm() * lag,
                     dot(line, sliding_at_mesh(pump, state)));
}

MotionChecks motion_checks(const PumpSystem& pump, const State& state, const Reactions& reactions,
                           const SimTK::Vector& udot, double lag) {
  return {contact_law_force(pump, state, lag), ring_power(pump, reactions, state),
          power_balance(pump, state, reactions, udot)};
}

}  // namespace bentaxis::multibody

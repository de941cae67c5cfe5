#include "reactions/inverse_dynamics.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

SpatialVec InverseDynamics::needed(const MobilizedBody& body, const Loads& loads) const {
  const State& state = pump_.dynamics();
  const SimTK::MobilizedBodyIndex index = body.getMobilizedBodyIndex();
  const SpatialVec inertia = body.getBodySpatialInertiaInGround(state) * accelerations_[index] +
                             pump_.matter().getGyroscopicForce(state, index);
  return inertia - loads[index];
}

void InverseDynamics::solve(Reactions& reactions) {
  const State& state = pump_.dynamics();
  const SimTK::SimbodyMatterSubsystem& matter = pump_.matter();
  const PumpBodies& bodies = pump_.bodies();
  pump_.system().realize(state, SimTK::Stage::Dynamics);
  const Loads& loads = pump_.system().getRigidBodyForces(state, SimTK::Stage::Dynamics);
  placement_.constrained_accelerations(udot_);
  matter.calcResidualForceIgnoringConstraints(
      state, pump_.system().getMobilityForces(state, SimTK::Stage::Dynamics), loads, udot_,
      residual_);
  matter.calcBodyAccelerationFromUDot(state, udot_, accelerations_);
  placement_.piston_solver().solve_forces(residual_, bore_);

  const Rotation& block = bodies.block.getBodyRotation(state);
  // The piston turns about A: what a force at B would do, one at C does by its own lever.
  const double lever = pump_.pump().geometry.piston_length / pump_.contact_length();
  reactions.pistons.resize(bodies.pistons.size());
  for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
    const MobilizedBody& piston = bodies.pistons[k];
    Reactions::OnPiston& on = reactions.pistons[k];
    on.acceleration = accelerations_[piston.getMobilizedBodyIndex()];
    on.place = piston.getBodyTransform(state);
    on.bore = block * pump_.bores()[k].force_in_base(lever * bore_[k][0], lever * bore_[k][1]);
    if (pump_.walls() != nullptr) on.wall = pump_.walls()->force_on_piston(state, k);
    const SpatialVec total = needed(piston, loads);
    on.joint = total[1] - on.bore;
    // The bore's force acts on the axis through A: it has no moment about it.
    on.axis_moment = dot(total[0], Vec3(on.place.z()));
  }
  if (!pump_.is_prescribed()) solve_block_and_shaft(reactions, loads);
}

void InverseDynamics::solve_block_and_shaft(Reactions& reactions, const Loads& loads) {
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
    const Vec3 contact = on.place.p() + pump_.contact_length() * Vec3(on.place.z());
    hold += SpatialVec((contact - o2) % on.bore, on.bore);
    on_shaft += SpatialVec((on.place.p() - c1) % on.joint, on.joint);
  }
  reactions.imposed = 0;
  if (pump_.joint() != nullptr) {
    // Its equation gives the directions of couple and force, the block's balance about z2 the size.
    const SpatialVec on_block = pump_.joint()->unit_on_block(state);
    const SpatialVec unit_on_shaft = pump_.joint()->unit_on_shaft(state);
    const double size = dot(hold[0], z2) / dot(on_block[0], z2);
    reactions.couple = size * on_block[0];
    reactions.side_force = size * on_block[1];
    hold[0] -= reactions.couple;
    hold[1] -= reactions.side_force;
    on_shaft[0] -= size * (unit_on_shaft[0] + (o2 - c1) % unit_on_shaft[1]);
    on_shaft[1] -= size * unit_on_shaft[1];
  } else if (pump_.bevel() != nullptr) {
    // Their forces are among the loads. What is left about z2 they do not give.
    reactions.imposed = dot(hold[0], z2);
    hold[0] -= reactions.imposed * z2;
    reactions.tooth = (reactions.imposed + pump_.bevel_torque_on_block(state)) / pump_.gear().arm();
    reactions.tooth_line = pump_.gear().line_for(reactions.tooth);
  } else if (pump_.has_gear()) {
    // The arm about z2 is that of either flank; the sign tells which of them pushes.
    const Vec3 on_block = (pump_.gear().point() - o2) % pump_.gear().line_for(0);
    reactions.tooth = dot(hold[0], z2) / dot(on_block, z2);
    reactions.tooth_line = pump_.gear().line_for(reactions.tooth);
    const Vec3 tooth = reactions.tooth * reactions.tooth_line;
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

}  // namespace bentaxis::multibody

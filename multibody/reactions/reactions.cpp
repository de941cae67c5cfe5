#include "reactions/reactions.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

void realize_with_flank(const PumpSystem& pump, State& state) {
  const auto realize = [&](bool negative) {
    if (pump.has_gear() && pump.gear().setting().negative != negative) {
      pump.gear().setting().negative = negative;
      state.invalidateAllCacheAtOrAbove(SimTK::Stage::Velocity);
    }
    pump.system().realize(state, SimTK::Stage::Acceleration);
  };
  realize(false);
  if (!pump.has_rigid_gear() || !pump.gear().has_two_flanks()) return;
  if (pump.gear().tooth_force(state) < 0) realize(true);
}

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
    if (pump.walls() != nullptr) on.wall = pump.walls()->force_on_piston(state, k);
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
  reactions.drive = pump.torque_on_shaft(state);
  if (pump.has_gear()) {
    reactions.tooth = pump.tooth_force(state);
    reactions.tooth_line =
        pump.has_rigid_gear() ? pump.gear().line() : pump.gear().line_for(reactions.tooth);
  }
  if (pump.joint() != nullptr) {
    const SpatialVec carried = pump.joint()->on_block(state);
    reactions.couple = carried[0];
    reactions.side_force = carried[1];
  }
  reactions.imposed = pump.block_is_imposed() ? pump.imposed_block_torque(state) : 0;
}

}  // namespace bentaxis::multibody

#include "reactions/budget.h"

#include <utility>

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;
using SimTK::Vector;

namespace {

using OnBodies = SimTK::Vector_<SpatialVec>;  // forces or velocities, one per body

// A motion that the pistons' bores allow.
struct Motion {
  Vector speeds;        // of the mobilities
  OnBodies velocities;  // of the bodies

  double power(const OnBodies& forces) const {
    double power = 0;
    for (int b = 1; b < forces.size(); ++b)  // without Ground
      power += dot(forces[b][0], velocities[b][0]) + dot(forces[b][1], velocities[b][1]);
    return power;
  }
};

Motion turning(const PumpSystem& pump, const PistonSolver& pistons, double shaft, double block) {
  const State& state = pump.dynamics();
  const PumpBodies& bodies = pump.bodies();
  Motion motion;
  motion.speeds.resize(state.getNU());
  motion.speeds = 0;
  motion.speeds[bodies.shaft.getFirstUIndex(state) + 2] = shaft;
  motion.speeds[bodies.block.getFirstUIndex(state)] = block;
  pistons.allowed_speeds(state, shaft * Vec3(0, 0, 1), block * Vec3(bodies.block_frame.z()), 0,
                         motion.speeds);
  pump.matter().multiplyBySystemJacobian(state, motion.speeds, motion.velocities);
  return motion;
}

}  // namespace

namespace {

// Speed of the block over that of the shaft that a joint lets through: its couple does no work.
double block_over_shaft(const PumpSystem& pump, const State& state) {
  return -dot(pump.joint()->unit_on_shaft(state)[0], Vec3(0, 0, 1)) /
         dot(pump.joint()->unit_on_block(state)[0], Vec3(pump.bodies().block_frame.z()));
}

}  // namespace

Budget budget_of(PumpSystem& pump, Placement& placement, const Reactions& reactions) {
  const State& state = pump.dynamics();
  const PumpBodies& bodies = pump.bodies();
  const Vec3 z2(bodies.block_frame.z());
  const Motion shaft_turns = turning(pump, placement.piston_solver(), 1, 0);
  const Motion block_turns = turning(pump, placement.piston_solver(), 0, 1);

  Budget budget;
  OnBodies forces;
  SimTK::Vector_<Vec3> particles;
  Vector mobilities;
  // Gear, joint or walls pass on to the shaft what the block needs: as much torque per torque on
  // the block as they exert on the shaft. An imposed motion supplies it.
  double passed_on = pump.has_gear() ? 1 : 0;
  if (pump.joint() != nullptr) passed_on = block_over_shaft(pump, state);
  if (pump.walls() != nullptr) {
    pump.walls()->force().calcForceContribution(state, forces, particles, mobilities);
    budget.carrying_torque = block_turns.power(forces);
    if (budget.carrying_torque != 0)
      passed_on = -shaft_turns.power(forces) / budget.carrying_torque;
  }
  const auto put = [&](Cause cause, double on_shaft, double on_block) {
    budget.carrying_of(cause) = on_block;
    budget.drive_of(cause) = on_shaft + passed_on * on_block;
  };
  const auto along_axis = [&] { return dot(z2, forces[bodies.block.getMobilizedBodyIndex()][1]); };
  const auto put_forces = [&](Cause cause) {
    put(cause, -shaft_turns.power(forces), -block_turns.power(forces));
    budget.pressing += along_axis();
  };
  const auto find_only = [&](LoadSource source) {
    pump.inputs().only = source;
    pump.loads().calcForceContribution(state, forces, particles, mobilities);
    pump.inputs().only.reset();
  };

  const std::pair<Cause, LoadSource> loads[] = {
      {Cause::pressure, LoadSource::pressure},
      {Cause::piston_friction, LoadSource::piston_friction},
      {Cause::block_friction, LoadSource::block_friction},
      {Cause::shaft_friction, LoadSource::shaft_friction}};
  for (const auto& [cause, source] : loads) {
    find_only(source);
    put_forces(cause);
  }
  pump.weight().calcForceContribution(state, forces, particles, mobilities);
  put_forces(Cause::weight);

  Vector accelerations;
  Vector residual;
  placement.constrained_accelerations(accelerations);
  pump.matter().calcResidualForceIgnoringConstraints(state, Vector(), OnBodies(), accelerations,
                                                     residual);
  put(Cause::inertia, ~residual * shaft_turns.speeds, ~residual * block_turns.speeds);

  if (!pump.contact_at_b()) {
    // The bores' forces, on piston and block: what moves one past the other is the play.
    forces.resize(pump.matter().getNumBodies());
    forces = SpatialVec(Vec3(0), Vec3(0));
    for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
      const Reactions::OnPiston& on = reactions.pistons[k];
      const Vec3 contact = on.place.p() + pump.contact_length() * Vec3(on.place.z());
      const auto push = [&](const SimTK::MobilizedBody& body, const Vec3& force) {
        forces[body.getMobilizedBodyIndex()] +=
            SpatialVec((contact - body.getBodyOriginLocation(state)) % force, force);
      };
      push(bodies.pistons[k], on.bore);
      push(bodies.block, -on.bore);
    }
    put_forces(Cause::ring);
  }

  budget.drive_torque = reactions.drive / pump.pump().friction.shaft_torque_factor;
  budget.drive_of(Cause::torque_factor) =
      (1 - pump.pump().friction.shaft_torque_factor) * budget.drive_torque;

  find_only(LoadSource::spring);
  budget.pressing += along_axis();
  if (pump.bevel() != nullptr) {
    budget.carrying_torque = reactions.tooth * pump.gear().arm();
    // At one speed of shaft and block: what goes into the teeth and does not come out of them.
    budget.drive_of(Cause::teeth) = -pump.bevel_torque_on_shaft(state) - budget.carrying_torque;
    budget.pressing += dot(z2, vector_of(pump.bevel()->action(state).force));
  } else if (pump.joint() != nullptr) {
    budget.carrying_torque = dot(z2, reactions.couple);
    budget.pressing += dot(z2, reactions.side_force);
  } else if (pump.has_gear()) {
    const GearMesh& gear = pump.gear();
    budget.carrying_torque =
        reactions.tooth * dot(z2, (gear.point() - bodies.block_origin) % reactions.tooth_line);
    budget.pressing += reactions.tooth * dot(z2, reactions.tooth_line);
  } else if (pump.walls() == nullptr) {
    budget.carrying_torque = reactions.imposed;
  }
  find_only(LoadSource::film);
  budget.separating = along_axis();
  budget.film = dot(z2, reactions.block_hold[1]);
  return budget;
}

}  // namespace bentaxis::multibody

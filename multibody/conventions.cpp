#include "conventions.h"

namespace bentaxis::multibody {

using SimTK::ConstrainedBodyIndex;
using SimTK::SpatialVec;

SpatialVec constraint_force_on(const SimTK::State& state, const SimTK::Constraint& constraint,
                               const SimTK::MobilizedBody& body) {
  const SimTK::Vector_<SpatialVec> forces = constraint.getConstrainedBodyForcesAsVector(state);
  for (ConstrainedBodyIndex i(0); i < constraint.getNumConstrainedBodies(); ++i)
    if (constraint.getMobilizedBodyFromConstrainedBody(i).getMobilizedBodyIndex() ==
        body.getMobilizedBodyIndex())
      return -forces[i];
  return SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0));
}

int InlineJoint::first_row(const SimTK::State& state) const {
  SimTK::MultiplierIndex position;
  SimTK::MultiplierIndex velocity;
  SimTK::MultiplierIndex acceleration;
  constraint_.getIndexOfMultipliersInUse(state, position, velocity, acceleration);
  return position;
}

SimTK::Vec3 InlineJoint::force_in_base(const SimTK::State& state) const {
  const SimTK::Vector& multipliers = state.getMultipliers();
  const int row = first_row(state);
  return force_in_base(-multipliers[row], -multipliers[row + 1]);
}

void joint_forces(const SimTK::State& state, const SimTK::SimbodyMatterSubsystem& matter,
                  SimTK::Vector_<SpatialVec>& forces) {
  matter.calcMobilizerReactionForces(state, forces);
}

}  // namespace bentaxis::multibody

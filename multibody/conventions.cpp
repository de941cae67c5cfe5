#include "conventions.h"

namespace bentaxis::multibody {

using SimTK::ConstrainedBodyIndex;
using SimTK::SpatialVec;

namespace {

// Of forces on the constrained bodies that on one of them, as an applied force.
SpatialVec applied_to(const SimTK::MobilizedBody& body, const SimTK::Constraint& constraint,
                      const SimTK::Vector_<SpatialVec>& forces) {
  for (ConstrainedBodyIndex i(0); i < constraint.getNumConstrainedBodies(); ++i)
    if (constraint.getMobilizedBodyFromConstrainedBody(i).getMobilizedBodyIndex() ==
        body.getMobilizedBodyIndex())
      return -forces[i];
  return SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0));
}

}  // namespace

SpatialVec constraint_force_on(const SimTK::State& state, const SimTK::Constraint& constraint,
                               const SimTK::MobilizedBody& body) {
  return applied_to(body, constraint, constraint.getConstrainedBodyForcesAsVector(state));
}

SpatialVec unit_constraint_force_on(const SimTK::State& state, const SimTK::Constraint& constraint,
                                    const SimTK::MobilizedBody& body) {
  SimTK::Vector_<SpatialVec> forces;
  SimTK::Vector of_mobilities;
  constraint.calcConstraintForcesFromMultipliers(state, SimTK::Vector(1, 1.0), forces,
                                                 of_mobilities);
  return applied_to(body, constraint, forces);
}

int InlineJoint::first_row(const SimTK::State& state) const {
  SimTK::MultiplierIndex position;
  SimTK::MultiplierIndex velocity;
  SimTK::MultiplierIndex acceleration;
  constraint_.getIndexOfMultipliersInUse(state, position, velocity, acceleration);
  return position + first_;
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

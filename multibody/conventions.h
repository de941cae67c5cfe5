// Simbody's sign and frame conventions for reactions, each wrapped once.
//
// Simbody 3.7 reports constraint forces and multipliers with the sign opposite to applied forces,
// and mobilizer reactions with the sign of applied forces. Here every value is what the second body
// exerts on the first, in Ground. tests/simbody_conventions_test.cpp pins each against a free-body
// diagram.
#pragma once

#include <SimTKsimbody.h>

namespace bentaxis::multibody {

/// Force (at the body's origin) and moment that a constraint exerts on one of its bodies.
/// @param state  realized to Acceleration
SimTK::SpatialVec constraint_force_on(const SimTK::State& state,
                                      const SimTK::Constraint& constraint,
                                      const SimTK::MobilizedBody& body);

/// Forces and moments of all mobilizers on their bodies at the outboard frame's origin M.
/// Index by MobilizedBodyIndex.
void joint_forces(const SimTK::State& state, const SimTK::SimbodyMatterSubsystem& matter,
                  SimTK::Vector_<SimTK::SpatialVec>& forces);

/// Generalized force that a one-equation speed or acceleration constraint applies to its mobility.
template <class OneMobilityConstraint>
double applied_generalized_force(const SimTK::State& state, const OneMobilityConstraint& drive) {
  return -drive.getMultiplier(state);
}

}  // namespace bentaxis::multibody

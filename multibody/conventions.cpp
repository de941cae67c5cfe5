#include "bentaxis/multibody/conventions.h"

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

void joint_forces(const SimTK::State& state, const SimTK::SimbodyMatterSubsystem& matter,
                  SimTK::Vector_<SpatialVec>& forces) {
  matter.calcMobilizerReactionForces(state, forces);
}

}  // namespace bentaxis::multibody

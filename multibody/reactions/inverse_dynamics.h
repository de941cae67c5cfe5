// Reactions of a placed pump by inverse dynamics: no mass matrix, no multipliers.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "placement/placement.h"
#include "reactions/reactions.h"

namespace bentaxis::multibody {

/// By inverse dynamics at the last placement: the generalized forces that given accelerations leave
/// to be supplied, and the free bodies of pistons, block and shaft. No mass matrix is factored and
/// no multiplier solved for.
class InverseDynamics {
 public:
  InverseDynamics(PumpSystem& pump, Placement& placement) : pump_(pump), placement_(placement) {}
  /// Realizes the dynamics state to Dynamics and finds accelerations too.
  void solve(Reactions& reactions);

 private:
  using Loads = SimTK::Vector_<SimTK::SpatialVec>;  // on the bodies
  void solve_block_and_shaft(Reactions& reactions, const Loads& loads);
  /// Force and moment about the body's origin that its motion needs beyond the applied loads.
  SimTK::SpatialVec needed(const SimTK::MobilizedBody& body, const Loads& loads) const;

  PumpSystem& pump_;
  Placement& placement_;
  SimTK::Vector udot_, residual_;
  SimTK::Vector_<SimTK::SpatialVec> accelerations_;
  std::vector<SimTK::Vec3> bore_;
};

}  // namespace bentaxis::multibody

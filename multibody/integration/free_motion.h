// Accelerations of the bodies that move freely, by coordinate partitioning.
#pragma once

#include <SimTKsimbody.h>

#include "placement/placement.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// Solves the equations of motion along the motions that the constraints allow: of the shaft, of
/// the block, which with rigid teeth or a joint follows the shaft, and of a rotor. Along them
/// constraints do no work, so no multiplier is sought: Simbody's own solution for all of them
/// factors a matrix of all constraint equations. Masses, forces and velocities are Simbody's.
class FreeMotion {
 public:
  struct Accelerations {
    double shaft = 0, block = 0, rotor = 0;  ///< rad/s2
    double torque_on_shaft = 0;  ///< Nm about z1, that moves the shaft as given; 0 where it is free
  };

  /// @param pump, placement  outlive it
  FreeMotion(PumpSystem& pump, Placement& placement);

  /// At the last placement; the shaft's acceleration there counts where its speed is given.
  /// @param ratio  speed of the block over that of the shaft, where a gear or joint prescribes it
  Accelerations solve(bool shaft_is_free, double ratio = 1);

 private:
  void allow(double shaft, double block, SimTK::Vector& speeds, SimTK::Vector& momenta) const;

  PumpSystem& pump_;
  Placement& placement_;
  int shaft_u_, block_u_;
  SimTK::Vector udot_, residual_;
  SimTK::Vector by_shaft_, by_block_, shaft_momenta_, block_momenta_;
};

}  // namespace bentaxis::multibody

// Reactions of a placed pump, and reading them from Simbody's constraint multipliers.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// Forces found at an instant, all in Ground, on the first body named.
struct Reactions {
  struct OnPiston {
    SimTK::Vec3 joint;                  ///< by the shaft, at A
    SimTK::Vec3 bore;                   ///< by the block, at B or at the ring's contact point
    SimTK::Vec3 wall = SimTK::Vec3(0);  ///< by the wall of its bore, at D
    double axis_moment = 0;  ///< about its own axis, that would have to be supplied: must vanish
    SimTK::SpatialVec acceleration;  ///< of the body at A: angular, linear
    SimTK::Transform place;          ///< of the body: A and its axes
  };
  std::vector<OnPiston> pistons;
  // Not found where shaft and block are prescribed:
  SimTK::SpatialVec block_hold;      ///< by film and pin together, about O2: moment, force
  SimTK::Vec3 tapered, cylindrical;  ///< on the shaft by its bearings
  double drive = 0;                  ///< torque about z1 on the shaft after proportional losses, Nm
  double tooth = 0;        ///< tooth force on the block along tooth_line, N; of bevel teeth the
                           ///< torque that the block's motion takes over GearMesh::arm()
  SimTK::Vec3 tooth_line;  ///< of the flank that carries it
  SimTK::Vec3 couple = SimTK::Vec3(0);      ///< on the block by a joint, about O2, Nm
  SimTK::Vec3 side_force = SimTK::Vec3(0);  ///< on the block by a joint, at O2
  double imposed = 0;  ///< torque about z2 that an imposed motion applies to the block; beside
                       ///< bevel teeth what they do not give of what its motion takes
  /// Whether `imposed` is what given motion needs; false where the motion was chosen so that it
  /// needs none.
  bool block_is_given = true;
};

/// Realizes a dynamics state to Acceleration with that flank of the gear in mesh that can carry the
/// tooth force found: a flank pushes and does not pull.
void realize_with_flank(const PumpSystem& pump, SimTK::State& state);

/// From a dynamics state realized to Acceleration: Simbody's multipliers and joint reactions.
void reactions_from_multipliers(const PumpSystem& pump, const SimTK::State& state,
                                Reactions& reactions);

}  // namespace bentaxis::multibody

// Tapered pistons that touch the walls of their bores: surfaces, contact and force.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "bentaxis/pump/parameters.h"
#include "loads/loads.h"
#include "scene/piston.h"

namespace bentaxis::multibody {

/// Which branch of its contact law a wall is on. Within one the force is smooth; an integration
/// lands where it changes.
struct WallBranch {
  bool touching = false;
  bool released = false;  ///< so fast apart that the wall, still pressed in, follows no more
};

/// How the walls act. Changed by whoever runs the pump, who then invalidates the state's forces.
struct WallSetting {
  bool apart = false;            ///< nothing acts
  std::vector<WallBranch> held;  ///< branch of each piston; empty: the one that holds at the state
};

/// What a piston and the wall of its bore do to each other.
struct WallTouch {
  SimTK::Vec3 centre;   ///< of the piston's sphere, D, in Ground
  SimTK::Vec3 outward;  ///< unit vector in Ground, from the bore's axis to D
  double approach = 0;  ///< m, of the surfaces into each other; below 0: the gap between them
  double rate = 0;      ///< m/s, of the approach
  double force = 0;     ///< N, on the wall along `outward`; its opposite acts on the piston
};

/// The walls as a force element. Where a piston touches its bore it is a sphere about D on its
/// axis, whose radius is smaller than the bore's by its clearance; the wall is a cylinder in the
/// block. The element finds where the two surfaces are deepest in each other, and how fast they
/// approach, from the places and velocities of the bodies. Its force acts along the common normal,
/// which passes through D. There is no friction.
class BoreWalls {
 public:
  /// @param setting  read at every evaluation; outlives the system, like all arguments
  BoreWalls(SimTK::GeneralForceSubsystem& forces, const PumpParameters& pump,
            const PumpBodies& bodies, const Pistons& pistons, const WallSetting& setting);

  std::size_t size() const { return pistons_.size(); }
  /// @param state  realized to Velocity
  WallTouch touch(const SimTK::State& state, std::size_t piston) const;
  /// Force on a piston at D, N in Ground.
  SimTK::Vec3 force_on_piston(const SimTK::State& state, std::size_t piston) const;
  /// The branch that holds at a state.
  WallBranch branch_at(const SimTK::State& state, std::size_t piston) const;
  /// Energy that their springs hold, J, and its rate, W.
  double elastic_energy(const SimTK::State& state) const;
  double elastic_power(const SimTK::State& state) const;
  /// Sum of the forces of all walls, N.
  double total_force(const SimTK::State& state) const;
  /// Torque about the block's axis per angle, Nm/rad, of one wall that carries a torque, Nm.
  double torsional_stiffness(double torque) const;
  /// The element, for what it applies.
  const SimTK::Force& force() const { return force_; }
  const WallContact& law() const { return law_; }

 private:
  class Element;
  double force_of(const WallTouch& touch, std::size_t piston) const;

  WallContact law_;
  double bore_radius_;
  std::vector<double> sphere_radii_;  // m, one per piston
  double arm_;                        // m, of a wall's force about the block's axis, per force
  SimTK::MobilizedBody block_;
  std::vector<SimTK::MobilizedBody> pistons_;
  std::vector<SimTK::Vec3> bore_points_;
  const WallSetting& setting_;
  SimTK::Force force_;
};

}  // namespace bentaxis::multibody

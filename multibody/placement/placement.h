// Puts a pump at an angle: positions, speeds and accelerations that its constraint equations allow.
#pragma once

#include <SimTKsimbody.h>

#include <optional>

#include "bentaxis/results/instant.h"
#include "placement/piston_solver.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// A constraint equation this far off, m, is not met: what an assembly must reach to count as one,
/// and times the larger of 1 rad/s and |omega| its speeds. A hundred times the round-off of
/// coordinates of some 0.1 m; the solver goes on below it as far as round-off lets it.
inline constexpr double kAssemblyTolerance = 1e-12;

/// Places a pump system's two states.
class Placement {
 public:
  /// @param pump  must outlive the placement
  explicit Placement(PumpSystem& pump);

  /// Assembles positions and velocities for given angles and speeds in the assembly state, by
  /// Simbody's own projection from any start.
  /// @throws ComputationError where no assembly is found.
  void assemble(const AxisMotion& shaft, const AxisMotion& block);

  /// Copies positions and velocities of the assembly to the dynamics state at the same time.
  void copy_assembly_to_dynamics();

  /// Puts the dynamics state at a given motion of shaft and block: positions and speeds, guessed,
  /// then brought to where the constraint equations hold to round-off. Leaves it realized to
  /// Velocity.
  /// @param rotor_speed  rad/s, of a motor's rotor where there is one
  /// @throws ComputationError where no assembly is found.
  void place(const AxisMotion& shaft, const AxisMotion& block, double rotor_speed = 0);

  /// Accelerations of all mobilities as the constraint equations have them at the last placement.
  void constrained_accelerations(SimTK::Vector& udot);

  const PistonSolver& piston_solver() const { return solver_; }

 private:
  void guess_pistons();
  void set_piston_spins();
  void set_turning(const AxisMotion& shaft, const AxisMotion& block, double time);
  bool guess_placement();
  bool solve_placement();

  PumpSystem& pump_;
  const SimTK::MultibodySystem& system_;
  const SimTK::SimbodyMatterSubsystem& matter_;
  const PumpBodies& bodies_;
  SimTK::State& assembly_;
  SimTK::State& dynamics_;
  PistonSolver solver_;
  struct Angles {
    double shaft = 0, block = 0;
  };
  std::optional<Angles> assembled_;
  AxisMotion placed_shaft_, placed_block_;
};

}  // namespace bentaxis::multibody

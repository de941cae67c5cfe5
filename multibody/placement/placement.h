// Puts a pump at an angle: positions, speeds and accelerations that its constraint equations allow.
#pragma once

#include <SimTKsimbody.h>

#include <optional>

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

  /// Assembles positions and velocities for the given angle and speed in the assembly state, by
  /// Simbody's own projection from any start.
  /// @throws ComputationError where no assembly is found.
  void assemble(double theta, double omega);

  /// Copies positions and velocities of the assembly to the dynamics state at the same time.
  void copy_assembly_to_dynamics();

  /// Puts the dynamics state at the given angle, speed and rate of speed: positions and speeds,
  /// guessed, then brought to where the constraint equations hold to round-off. Leaves it realized
  /// to Velocity.
  /// @throws ComputationError where no assembly is found.
  void place(double theta, double omega, double omega_dot);

  /// Accelerations of all mobilities as the constraint equations have them at the last placement.
  void constrained_accelerations(SimTK::Vector& udot);

  const PistonSolver& piston_solver() const { return solver_; }

 private:
  void guess_pistons();
  void set_piston_spins();
  bool guess_placement(double theta);
  bool solve_placement();

  const PumpSystem& pump_;
  const SimTK::MultibodySystem& system_;
  const SimTK::SimbodyMatterSubsystem& matter_;
  const PumpBodies& bodies_;
  SimTK::State& assembly_;
  SimTK::State& dynamics_;
  Turning& turning_;
  PistonSolver solver_;
  std::optional<double> assembled_theta_;
  double placed_theta_ = 0, placed_omega_dot_ = 0;
};

}  // namespace bentaxis::multibody

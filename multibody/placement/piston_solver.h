// Positions, speeds and accelerations of the pistons from Simbody's constraint equations.
//
// With shaft and block given, each piston has its own two equations (B on its bore axis): Simbody's
// general projection, which solves all of them together, is not needed. Errors of position and
// speed are Simbody's, those of acceleration of the same constraint; the matrix of a piston's
// equations is put together from its joint's partial velocities, and a wrong one would show in
// those errors.
#pragma once

#include <SimTKsimbody.h>

#include <vector>

#include "scene/piston.h"

namespace bentaxis::multibody {

class PistonSolver {
 public:
  /// @param state  any state that it will be used with has the same constraints in use; realized to
  ///               Instance
  /// @param spin   absolute speed of each piston about its own axis, rad/s, used where the joint
  ///               leaves it free (three mobilities)
  PistonSolver(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
               const SimTK::MobilizedBody& shaft, const SimTK::MobilizedBody& block,
               const Pistons& pistons, double piston_length, double spin,
               const SimTK::State& state);

  /// Newton's method from the positions in the state, shaft and block as they stand there. Leaves
  /// the state realized to Position.
  /// @return largest error of an equation that is left, m
  double solve_positions(SimTK::State& state);

  /// Speeds that keep the equations with shaft and block as they turn in the state. Leaves the
  /// state realized to Velocity.
  /// @return largest error of the rate of an equation that is left, m/s
  double solve_speeds(SimTK::State& state);

  /// The pistons' speeds for any turning of shaft and block at the positions of the last
  /// solve_speeds(): speeds that the constraints allow.
  /// @param shaft_rate, block_rate  angular velocities, rad/s in Ground
  /// @param spin  absolute speed of each piston about its own axis where the joint leaves it free
  /// @param u     of all mobilities; the pistons' are set
  void allowed_speeds(const SimTK::State& state, const SimTK::Vec3& shaft_rate,
                      const SimTK::Vec3& block_rate, double spin, SimTK::Vector& u) const;

  /// Accelerations that keep the equations (and the spin), where those of all other mobilities are
  /// given in `udot`. State realized to Velocity by solve_speeds().
  void solve_accelerations(const SimTK::State& state, SimTK::Vector& udot);

  /// What the pistons' generalized forces ask of their bores: force on each piston along the two
  /// axes of its bore's equations and, where spin is free, the moment about its own axis. At the
  /// state of the last solve_speeds().
  /// @param forces  generalized forces that constraints have to supply, per mobility
  /// @param bore    per piston: two components of force, N, and moment about the axis, Nm
  void solve_forces(const SimTK::Vector& forces, std::vector<SimTK::Vec3>& bore) const;

 private:
  struct Piston {
    SimTK::MobilizedBody body;
    InlineJoint bore;
    int row = 0;                   // first of its equations
    int u = 0, nu = 0;             // mobilities
    int q = 0;                     // its quaternion
    SimTK::Mat33 matrix, inverse;  // equations (and spin) by mobilities, padded to 3x3
    SimTK::Vec3 turn[3];           // angular velocity per unit of speed of each mobility
  };

  void find_matrices(const SimTK::State& state);
  SimTK::Vec3 axis_in_shaft(const SimTK::State& state, const Piston& piston) const;

  const SimTK::MultibodySystem& system_;
  const SimTK::SimbodyMatterSubsystem& matter_;
  SimTK::MobilizedBody shaft_, block_;
  std::vector<Piston> pistons_;
  double length_, round_off_, spin_;
  double turned_ = SimTK::Infinity;  // largest turn of a piston since the matrices were found, rad
  InlineJoints bores_;
  SimTK::Vector_<SimTK::SpatialVec> accelerations_;
  std::vector<double> errors_;
  std::vector<SimTK::Vec3> changes_;
};

}  // namespace bentaxis::multibody

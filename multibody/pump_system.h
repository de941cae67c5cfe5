// The pump as Simbody bodies, joints, constraints and loads.
//
// It mirrors the virtual pump of Roccatello & Nervegna (2009), section 7:
//   shaft   on a spherical joint at C1 (tapered bearing), with its axis kept on z1 by an inline
//           joint at C2 (cylindrical bearing), turned at a given rate;
//   block   turning about z2 on ground (pin and port plate);
//   piston  on a spherical joint at A to the shaft, with B kept on its bore axis by an inline
//           joint to the block;
//   gear    a force along z4 at O4 between shaft and block (mesh), or the block's speed imposed.
// With a prescribed drive, shaft and block are moved and nothing that holds or drives them is
// built.
#pragma once

#include <SimTKsimbody.h>

#include <memory>
#include <optional>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "gear_mesh.h"
#include "loads.h"
#include "piston_solver.h"

namespace bentaxis::multibody {

/// Prescribed rotation of shaft and block: angle, speed and rate as a function of time.
struct Turning {
  double theta = 0;      ///< rad at time start
  double start = 0;      ///< s
  double omega = 0;      ///< rad/s
  double omega_dot = 0;  ///< rad/s2, at the instant; only for evaluation at time start

  double angle(double time) const { return theta + omega * (time - start); }
};

/// How the shaft is turned in the dynamic scene.
enum class Drive {
  constant_speed,      ///< speed held by a constraint: integrated runs
  given_acceleration,  ///< rate of speed given: evaluation at an instant
  torque,              ///< free, under LoadInputs::shaft_torque
  prescribed,          ///< shaft and block prescribed: only pistons are solved for
};

/// A pump ready for Simbody's solvers. Two states serve two purposes: in `assembly` shaft and block
/// are prescribed and Simbody's projection finds the pistons from any start; in `dynamics`
/// everything is held by joints and constraints, whose forces are the reactions (a prescribed drive
/// prescribes shaft and block there too).
class PumpSystem {
 public:
  PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, double omega, Drive drive);
  PumpSystem(const PumpSystem&) = delete;
  PumpSystem& operator=(const PumpSystem&) = delete;

  /// Assembles positions and velocities for the given angle and speed in the assembly state.
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
  PistonSolver& piston_solver() { return *solver_; }

  /// @throws ComputationError if a piston has no inertia about its joint: then there are
  /// equilibrium
  ///         equations but no equations of motion.
  void require_piston_inertia() const;

  const PumpParameters& pump() const { return pump_; }
  const Assumptions& assumptions() const { return assumptions_; }
  const SimTK::MultibodySystem& system() const { return system_; }
  const SimTK::SimbodyMatterSubsystem& matter() const { return matter_; }
  const PumpBodies& bodies() const { return bodies_; }
  const SimTK::State& assembly() const { return assembly_; }
  SimTK::State& dynamics() { return dynamics_; }
  const SimTK::State& dynamics() const { return dynamics_; }
  LoadInputs& inputs() { return inputs_; }
  const LoadInputs& inputs() const { return inputs_; }

  const std::vector<InlineJoint>& bores() const { return bores_; }
  const InlineJoint& cylindrical_bearing() const { return cylindrical_; }
  const GearMesh& gear() const { return *gear_; }
  bool has_gear() const { return !is_prescribed() && assumptions_.gear == GearScene::mesh; }
  bool is_prescribed() const { return drive_ == Drive::prescribed; }

  /// Whether the pistons are rigid bodies that can turn about their own axis.
  bool pistons_free_to_spin() const { return pistons_free_to_spin_; }

  /// Torque about z1 that the drive constraint applies to the shaft, Nm.
  double drive_torque(const SimTK::State& state) const;
  /// Torque about z2 that the imposed motion applies to the block, Nm.
  double imposed_block_torque(const SimTK::State& state) const;
  void set_acceleration(SimTK::State& state, double omega_dot) const;

  /// Work of applied loads, and of drive and imposed motion, since time 0, J. Integrated with the
  /// state.
  double work_of_loads(const SimTK::State& state) const;
  double work_of_drives(const SimTK::State& state) const;

  /// Block angle minus shaft angle, rad in (-pi, pi].
  double gear_phase(const SimTK::State& state) const;

  /// Number of constraint equations and rank of their matrix G in the dynamics state.
  struct Rank {
    int equations = 0;
    int rank = 0;
    int mobilities = 0;
  };
  Rank constraint_rank(const SimTK::State& state) const;

 private:
  void add_shaft_and_block(double omega);
  void add_pistons();
  void guess_pistons();
  void set_piston_spins();
  bool solve_placement();

  PumpParameters pump_;
  Assumptions assumptions_;
  Drive drive_;
  LoadInputs inputs_;
  Turning turning_;

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  PumpBodies bodies_;
  SimTK::MobilizedBody::Ball shaft_;
  SimTK::MobilizedBody::Pin block_;
  SimTK::Motion shaft_motion_, block_motion_;
  InlineJoint cylindrical_;
  SimTK::Constraint::ConstantSpeed speed_;
  SimTK::Constraint::ConstantAcceleration acceleration_;
  std::unique_ptr<GearMesh> gear_;
  std::vector<InlineJoint> bores_;
  class WorkMeter;
  WorkMeter* work_ = nullptr;  // owned by its force element
  SimTK::State assembly_, dynamics_;
  bool pistons_free_to_spin_ = false;
  double piston_inertia_about_joint_ = 0;
  std::optional<double> assembled_theta_;
  std::unique_ptr<PistonSolver> solver_;
  bool guess_placement(double theta);
  std::vector<SimTK::Vec3> joint_points_, bore_points_;  // A in the shaft, the bores in the block
  double placed_theta_ = 0, placed_omega_dot_ = 0;
};

}  // namespace bentaxis::multibody

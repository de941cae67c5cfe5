// The pump as Simbody bodies, joints, constraints and loads, put together from its pieces.
//
// It mirrors the virtual pump of Roccatello & Nervegna (2009), section 7:
//   shaft   on a spherical joint at C1 (tapered bearing), with its axis kept on z1 by an inline
//           joint at C2 (cylindrical bearing), turned at a given rate;
//   block   turning about z2 on ground (pin and port plate);
//   piston  on a spherical joint at A to the shaft, with B kept on its bore axis by an inline
//           joint to the block;
//   gear    a force along z4 at O4 between shaft and block (mesh), or the block's speed imposed;
//           or another transfer: a joint between their rotations, or bores that touch the pistons.
// With a prescribed drive, shaft and block are moved and nothing that holds or drives them is
// built.
#pragma once

#include <SimTKsimbody.h>

#include <memory>
#include <optional>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "loads/loads.h"
#include "scene/drive.h"
#include "scene/drive_torque.h"
#include "scene/gear_mesh.h"
#include "scene/piston.h"
#include "scene/tooth_contact.h"
#include "scene/work_meter.h"
#include "teeth/teeth_element.h"
#include "transfers/bore_walls.h"
#include "transfers/joint.h"

namespace bentaxis::multibody {

/// What turns the shaft of a pump that is simulated: one of the two.
struct DriveInTime {
  TurningInTime turning;
  std::optional<TorqueInTime> torque;
};

/// A pump ready for Simbody's solvers. Two states serve two purposes: in `assembly` shaft and block
/// are prescribed and Simbody's projection finds the pistons from any start; in `dynamics`
/// everything is held by joints and constraints, whose forces are the reactions (a prescribed drive
/// prescribes shaft and block there too). Placement finds both.
class PumpSystem {
 public:
  PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, double omega, Drive drive);
  /// A pump that is simulated: compliant teeth give way.
  PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, const DriveInTime& drive);
  PumpSystem(const PumpSystem&) = delete;
  PumpSystem& operator=(const PumpSystem&) = delete;

  /// @throws ComputationError if a piston has no inertia about its joint: then there are
  /// equilibrium
  ///         equations but no equations of motion.
  void require_piston_inertia() const;

  const PumpParameters& pump() const { return pump_; }
  const Assumptions& assumptions() const { return assumptions_; }
  const SimTK::MultibodySystem& system() const { return system_; }
  const SimTK::SimbodyMatterSubsystem& matter() const { return matter_; }
  const PumpBodies& bodies() const { return bodies_; }
  const Pistons& pistons() const { return pistons_; }
  const SimTK::State& assembly() const { return assembly_; }
  SimTK::State& assembly() { return assembly_; }
  SimTK::State& dynamics() { return dynamics_; }
  const SimTK::State& dynamics() const { return dynamics_; }
  LoadInputs& inputs() { return inputs_; }
  const SimTK::Force& weight() const { return *weight_; }
  /// All other applied loads.
  const SimTK::Force& loads() const { return *loads_; }
  const LoadInputs& inputs() const { return inputs_; }
  /// How shaft and block turn where they are prescribed.
  Turning& shaft_turning() { return shaft_turning_; }
  Turning& block_turning() { return block_turning_; }

  const std::vector<InlineJoint>& bores() const { return pistons_.bores; }
  const InlineJoint& cylindrical_bearing() const { return cylindrical_; }
  const GearMesh& gear() const { return *gear_; }
  const ShaftDrive& drive() const { return *shaft_drive_; }
  bool has_gear() const {
    return !is_prescribed() && assumptions_.gear == BlockDrive::mesh &&
           pump_.transfer.kind == TransferKind::gear;
  }
  /// A joint between shaft and block, and the walls that turn the block; else null.
  const BlockJoint* joint() const { return joint_ ? &*joint_ : nullptr; }
  const BoreWalls* walls() const { return walls_ ? &*walls_ : nullptr; }
  WallSetting& wall_setting() { return wall_setting_; }
  /// Whether the gear is a constraint; bevel teeth, and compliant ones of a pump that is simulated,
  /// are not.
  bool has_rigid_gear() const { return has_gear() && !teeth_ && !bevel_; }
  /// Compliant teeth of a pump that is simulated; else null.
  const CompliantTeeth* teeth() const { return teeth_ ? &*teeth_ : nullptr; }
  ToothBranch& tooth_branch() { return tooth_branch_; }
  /// Bevel teeth in contact; else null. At given instants the block's motion is imposed beside
  /// them.
  const TeethElement* bevel() const { return bevel_ ? &*bevel_ : nullptr; }
  /// Whether the block's motion is imposed on its own joint: also at given instants where teeth or
  /// walls push it.
  bool block_is_imposed() const {
    if (is_prescribed() || pump_.transfer.is_joint()) return false;
    const bool pushed = bevel_.has_value() || pump_.transfer.kind == TransferKind::pistons;
    return pushed ? drive_ == Drive::given_acceleration : !has_gear();
  }
  TeethSetting& teeth_setting() { return teeth_setting_; }
  /// Torques that they exert on the block about z2 and on the shaft about z1, Nm.
  /// @param state  realized to Velocity
  double bevel_torque_on_block(const SimTK::State& state) const;
  double bevel_torque_on_shaft(const SimTK::State& state) const;
  /// What turns a shaft that runs free in a simulation; else null.
  const DriveTorque* drive_torque() const { return drive_torque_ ? &*drive_torque_ : nullptr; }
  bool is_prescribed() const { return drive_ == Drive::prescribed; }

  /// From A along a piston's axis to where the bore's force acts, m: to B unless the pump has a
  /// contact point of its own.
  double contact_length() const {
    return pump_.piston.contact.value_or(pump_.geometry.piston_length);
  }
  /// Whether the bore's force acts at B, where the bore guides the piston. Elsewhere it does work,
  /// which no ideal constraint can.
  bool contact_at_b() const { return contact_length() == pump_.geometry.piston_length; }

  /// Whether the pistons are rigid bodies that can turn about their own axis.
  bool pistons_free_to_spin() const { return piston_.free_to_spin; }

  /// Torque about z1 that turns the shaft, after proportional losses, Nm.
  /// @param state  realized to Acceleration
  double torque_on_shaft(const SimTK::State& state) const;
  /// Tooth force along GearMesh::line_for() it, N. @param state  realized to Acceleration
  double tooth_force(const SimTK::State& state) const;

  /// Torque about z2 that the imposed motion applies to the block, Nm.
  double imposed_block_torque(const SimTK::State& state) const;

  /// Work of applied loads, and of drive and imposed motion, of an integrated run.
  const WorkMeter& work() const { return *work_; }

  /// Block angle minus shaft angle, rad in (-pi, pi].
  double gear_phase(const SimTK::State& state) const;

 private:
  PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, double omega, Drive drive,
             const DriveInTime* in_time);
  void add_shaft_and_block(double omega, const DriveInTime* in_time);
  void make_states();
  double power_of_drives(const SimTK::State& state) const;

  PumpParameters pump_;
  Assumptions assumptions_;
  Drive drive_;
  PistonBody piston_;
  LoadInputs inputs_;
  Turning shaft_turning_, block_turning_;

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  PumpBodies bodies_;
  SimTK::MobilizedBody::Ball shaft_;
  SimTK::MobilizedBody::Pin block_;
  SimTK::Motion shaft_motion_, block_motion_;
  InlineJoint cylindrical_;
  std::optional<ShaftDrive> shaft_drive_;
  std::unique_ptr<GearMesh> gear_;
  Pistons pistons_;
  std::optional<SimTK::Force::UniformGravity> weight_;
  std::optional<PumpLoads> loads_;
  std::optional<DriveTorque> drive_torque_;
  ToothBranch tooth_branch_;
  std::optional<CompliantTeeth> teeth_;
  std::optional<BevelTeeth> bevel_teeth_;
  TeethSetting teeth_setting_;
  std::optional<TeethElement> bevel_;
  std::optional<BlockJoint> joint_;
  WallSetting wall_setting_;
  std::optional<BoreWalls> walls_;
  std::optional<WorkMeter> work_;
  SimTK::State assembly_, dynamics_;
};

}  // namespace bentaxis::multibody

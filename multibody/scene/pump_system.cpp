#include "scene/pump_system.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "loads/friction.h"
#include "scene/block.h"
#include "scene/shaft.h"

namespace bentaxis::multibody {

using SimTK::State;
using SimTK::Vec3;

namespace {

// Work of ordinary size, J: that of a simulation is held to its accuracy times that.
constexpr double kUnitWork = 1000;

}  // namespace

PumpSystem::PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, double omega,
                       Drive drive)
    : PumpSystem(pump, assumptions, omega, drive, nullptr) {}

PumpSystem::PumpSystem(const PumpParameters& pump, const Assumptions& assumptions,
                       const DriveInTime& drive)
    : PumpSystem(pump, assumptions, 1, drive.torque ? Drive::torque : Drive::given_turning,
                 &drive) {}

PumpSystem::PumpSystem(const PumpParameters& pump, const Assumptions& assumptions, double omega,
                       Drive drive, const DriveInTime* in_time)
    : pump_(pump),
      assumptions_(assumptions),
      drive_(drive),
      piston_(piston_body(pump, assumptions.inertia)),
      matter_(system_),
      forces_(system_) {
  if (drive == Drive::torque && !(pump.shaft.axial_inertia > 0 && pump.block.axial_inertia > 0))
    throw InputError("a free shaft needs axial inertias of shaft and block > 0");
  inputs_.rest_speed = rest_speed_at(pump.geometry, omega);
  inputs_.chamber_pressure = [](double, double, std::vector<double>& p) {
    std::fill(p.begin(), p.end(), 0.0);
  };
  add_shaft_and_block(omega, in_time);
  weight_.emplace(forces_, matter_, Vec3(0, -pump_.gravity, 0));
  pistons_ = add_pistons(pump_.geometry, piston_, shaft_, block_);
  bodies_.pistons = pistons_.bodies;
  loads_.emplace(forces_, pump_, assumptions_, bodies_, inputs_,
                 is_prescribed() ? LoadedBodies::pistons : LoadedBodies::all);
  if (in_time != nullptr) {
    if (in_time->torque) drive_torque_.emplace(matter_, forces_, *in_time->torque, shaft_);
    if (pump_.gear.contact == ToothContact::compliant && has_gear())
      teeth_.emplace(forces_, *pump_.gear.compliance, *gear_, shaft_, block_, tooth_branch_);
  }
  if (pump_.gear.contact == ToothContact::teeth && has_gear()) {
    bevel_teeth_.emplace(pump_, assumptions_.flanks);
    bevel_.emplace(forces_, *bevel_teeth_, shaft_, block_, bodies_.block_origin, teeth_setting_);
  }
  if (pump_.transfer.kind == TransferKind::pistons && !is_prescribed())
    walls_.emplace(forces_, pump_, bodies_, pistons_, wall_setting_);
  if (drive_ == Drive::constant_speed || drive_ == Drive::torque || drive_ == Drive::given_turning)
    work_.emplace(
        system_, matter_, forces_, [this](const State& state) { return power_of_drives(state); },
        in_time != nullptr ? kUnitWork : 1);
  make_states();
}

void PumpSystem::add_shaft_and_block(double omega, const DriveInTime* in_time) {
  const SimTK::Transform frame = block_frame(pump_.geometry);
  bodies_.block_frame = frame.R();
  bodies_.block_origin = frame.p();
  bodies_.shaft_origin = Vec3(0, 0, pump_.bearings.tapered_z);
  shaft_ = shaft_on_tapered_bearing(matter_, pump_);
  block_ = block_on_pin(matter_, pump_, frame);
  bodies_.shaft = shaft_;
  bodies_.block = block_;
  shaft_motion_ = turning_motion(shaft_, shaft_turning_, true);
  block_motion_ = turning_motion(block_, block_turning_, false);
  if (!is_prescribed()) cylindrical_ = multibody::cylindrical_bearing(matter_, shaft_, pump_);
  shaft_drive_.emplace(drive_, shaft_, omega,
                       in_time != nullptr ? in_time->turning : TurningInTime(),
                       pump_.geometry.joint_circle_radius);
  if (pump_.transfer.is_joint() && !is_prescribed()) joint_.emplace(pump_, shaft_, block_);
  if (has_gear()) gear_ = gear_of(pump_, matter_, shaft_, block_, bodies_.block_frame, omega);
}

void PumpSystem::make_states() {
  system_.realizeTopology();
  assembly_ = system_.getDefaultState();
  dynamics_ = system_.getDefaultState();
  if (!is_prescribed()) {
    // Assembly: shaft and block follow the prescribed turning, so what holds them is switched off.
    cylindrical_.constraint().disable(assembly_);
    shaft_drive_->disable(assembly_);
    if (has_gear()) gear_->disable(assembly_);
    if (joint_) joint_->disable(assembly_);
    // Dynamics: joints and constraints hold them; an imposed block keeps its motion, and so does
    // one with bevel teeth at a given instant: what they push need not be what its motion takes.
    shaft_motion_.disable(dynamics_);
    if (!block_is_imposed()) block_motion_.disable(dynamics_);
    if (teeth_ || bevel_) gear_->disable(dynamics_);
  }
  system_.realize(assembly_, SimTK::Stage::Instance);
  system_.realize(dynamics_, SimTK::Stage::Instance);
}

void PumpSystem::require_piston_inertia() const {
  if (!(piston_.inertia_about_joint() > 0))
    throw ComputationError(
        "multibody model: a piston without inertia about its joint A (mass 0, or all of it at A) "
        "has no equation of motion in Simbody; use --reactions residual, or the analytic model");
}

double PumpSystem::power_of_drives(const State& state) const {
  double power = 0;
  if (shaft_drive_->has_equation())
    power += shaft_drive_->torque(state) * shaft_.getBodyAngularVelocity(state)[2];
  if (drive_torque_) power += drive_torque_->power(state);
  if (block_is_imposed()) power += imposed_block_torque(state) * block_.getOneU(state, 0);
  return power;
}

double PumpSystem::torque_on_shaft(const State& state) const {
  return drive_torque_ ? pump_.friction.shaft_torque_factor * drive_torque_->torque(state)
                       : shaft_drive_->torque(state);
}

double PumpSystem::tooth_force(const State& state) const {
  if (bevel_) {
    const double imposed = block_is_imposed() ? imposed_block_torque(state) : 0;
    return (bevel_torque_on_block(state) + imposed) / gear_->arm();
  }
  return teeth_ ? teeth_->force(state) : gear_->tooth_force(state);
}

double PumpSystem::bevel_torque_on_block(const State& state) const {
  return bevel_teeth_->torque_on_block(bevel_->action(state));
}

double PumpSystem::bevel_torque_on_shaft(const State& state) const {
  return bevel_teeth_->torque_on_shaft(bevel_->action(state));
}

double PumpSystem::imposed_block_torque(const State& state) const {
  SimTK::Vector torques;
  matter_.findMotionForces(state, torques);
  return -block_.getOneFromUPartition(state, 0, torques);
}

double PumpSystem::gear_phase(const State& state) const {
  return std::remainder(turn_angle(block_.getBodyRotation(state), bodies_.block_frame) -
                            turn_angle(shaft_.getBodyRotation(state), SimTK::Rotation()),
                        2 * kPi);
}

}  // namespace bentaxis::multibody

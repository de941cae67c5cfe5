#include "integration/case_drive.h"

#include <string>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/trajectory.h"
#include "scene_facts.h"

namespace bentaxis::multibody {

void require_simulable(const Case& the_case, const Assumptions& assumptions) {
  validate(the_case);
  const DriveSpec& drive = bentaxis::drive_of(the_case);
  refuse_ring_off_b(the_case.pump);
  if (assumptions.gear == BlockDrive::imposed)
    throw InputError(
        "multibody model: the motion of the block is imposed, so it cannot be simulated: use gear "
        "= \"mesh\"");
  const bool block_accelerates =
      the_case.pump.block_moves_freely() || the_case.pump.transfer.is_uneven_joint();
  const bool speed_changes = drive.kind != DriveKind::speed || !drive.curve.time.empty();
  const std::string file = the_case.file.empty() ? "" : the_case.file.string() + ": ";
  const auto need = [&](double inertia, const char* key) {
    if (!(inertia > 0))
      throw InputError(file + "[" + key +
                       "] axial_inertia_kg_mm2 = 0: must be > 0 where the speed may change");
  };
  if (!has_equation_of_motion(the_case.pump, assumptions.inertia))
    throw InputError(file +
                     "[piston]: without inertia about A (mass 0, or all of it at A) pistons have "
                     "no equation of motion in Simbody: use the analytic model");
  if (speed_changes) need(the_case.pump.shaft.axial_inertia, "shaft");
  if (speed_changes || block_accelerates) need(the_case.pump.block.axial_inertia, "block");
}

CaseDrive::CaseDrive(const Case& the_case)
    : case_(the_case),
      spec_(*the_case.drive),
      omega_(rad_per_second(the_case.operation.speed_rpm)),
      curve_(spec_.curve.time.empty() ? std::nullopt : std::optional<TimeSignal>(spec_.curve)) {}

void CaseDrive::set_inputs(const Surroundings& outside) {
  require_drive(spec_, outside);
  outside_ = outside;
}

AxisMotion CaseDrive::turning(double time) const {
  if (outside_.shaft) return outside_.shaft_at(time);
  if (!curve_) return {omega_ * time, omega_, 0};
  return {curve_->integral(time), curve_->value(time), curve_->slope(time)};
}

DriveInTime CaseDrive::in_time() const {
  DriveInTime drive;
  if (gives_speed()) {
    drive.turning = [this](double time) { return turning(time); };
    return drive;
  }
  drive.torque.emplace();
  drive.torque->torque = [this](double time) {
    if (const auto torque = outside_.torque_at(time)) return *torque;
    return curve_ ? curve_->value(time) : spec_.torque;
  };
  drive.torque->motor_torque = [this](double speed) { return motor_torque(speed); };
  if (is_motor()) drive.torque->motor = spec_.motor;
  drive.torque->kept = case_.pump.friction.shaft_torque_factor;
  return drive;
}

double CaseDrive::motor_torque(double rotor_speed) const {
  return curve_ ? curve_->value(rotor_speed)
                : spec_.torque - spec_.motor->torque_slope * (rotor_speed - omega_);
}

double CaseDrive::start_speed() const {
  if (gives_speed() && curve_) return curve_->value(0);
  return spec_.start_speed.value_or(omega_);
}

double CaseDrive::start_torque() const {
  const double speed = start_speed();
  if (speed == 0) return 0;
  return is_motor() && curve_ ? curve_->value(speed) : spec_.torque;
}

std::vector<double> CaseDrive::breakpoints() const {
  return curve_ && !is_motor() ? curve_->breakpoints() : std::vector<double>();
}

}  // namespace bentaxis::multibody

// What turns the shaft of a case over time, and which cases Simbody can carry through time.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/results/surroundings.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// Refuses a case whose motion Simbody does not find.
/// @throws InputError where there is no [drive], the block's motion is imposed, bore forces act off
///         B, pistons have no equation of motion, an axial inertia is missing, or dry friction
///         jumps where speeds may vanish
void require_simulable(const Case& the_case, const Assumptions& assumptions);

/// The [drive] of a case as functions of time, or of a motor's speed.
class CaseDrive {
 public:
  /// @param the_case  with a drive; outlives it
  explicit CaseDrive(const Case& the_case);
  CaseDrive(const CaseDrive&) = delete;
  CaseDrive& operator=(const CaseDrive&) = delete;

  const DriveSpec& spec() const { return spec_; }
  bool gives_speed() const { return spec_.kind == DriveKind::speed; }
  bool is_motor() const { return spec_.kind == DriveKind::motor; }
  /// From now on these act from outside.
  void set_inputs(const Surroundings& outside);
  /// For a pump that it outlives.
  DriveInTime in_time() const;
  /// Of the shaft, where its speed is given.
  AxisMotion turning(double time) const;
  /// At time 0: rad/s of every body, Nm in the coupling of a motor.
  double start_speed() const;
  double start_torque() const;
  /// Times at which the law changes, s; that of a motor never does.
  std::vector<double> breakpoints() const;

 private:
  double motor_torque(double rotor_speed) const;

  const Case& case_;
  const DriveSpec& spec_;
  double omega_;  // rad/s, of [operation]
  std::optional<TimeSignal> curve_;
  Surroundings outside_;
};

}  // namespace bentaxis::multibody

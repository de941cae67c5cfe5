// What turns a shaft that runs free: a torque, or a rotor through a coupling.
#pragma once

#include <SimTKsimbody.h>

#include <functional>
#include <optional>

#include "bentaxis/pump/drive_spec.h"

namespace bentaxis::multibody {

/// The data of such a drive.
struct TorqueInTime {
  std::function<double(double time)> torque;               ///< Td, Nm, where no motor drives
  std::function<double(double rotor_speed)> motor_torque;  ///< on the rotor, Nm
  std::optional<MotorData> motor;
  double kept = 1;  ///< Ct: the share of Td that turns the shaft (38)
};

/// The force element of a drive and, where there is a motor, its rotor: a body that turns about z1.
/// The twist of the coupling is a variable of its own.
class DriveTorque {
 public:
  /// @param shaft  outlives the system
  DriveTorque(SimTK::SimbodyMatterSubsystem& matter, SimTK::GeneralForceSubsystem& forces,
              const TorqueInTime& drive, const SimTK::MobilizedBody& shaft);

  bool has_rotor() const { return drive_.motor.has_value(); }
  /// Speed of the rotor, rad/s.
  double rotor_speed(const SimTK::State& state) const;
  void set_rotor_speed(SimTK::State& state, double speed) const;
  double rotor_inertia() const { return drive_.motor->rotor_inertia; }  ///< kg m2
  int rotor_u(const SimTK::State& state) const;                         ///< index of its speed
  /// Of the coupling, rad.
  void set_twist(SimTK::State& state, double twist) const;
  /// Sets speed of the rotor and torque in the coupling.
  void start(SimTK::State& state, double speed, double torque) const;
  /// Td, Nm. State realized to Velocity.
  double torque(const SimTK::State& state) const;
  /// Power of the torque that enters from outside, W: on the shaft, or on the rotor.
  double power(const SimTK::State& state) const;
  /// Energy in the coupling, J.
  double elastic_energy(const SimTK::State& state) const;

 private:
  class Element;
  TorqueInTime drive_;
  Element* element_;  // owned by its force subsystem
};

}  // namespace bentaxis::multibody

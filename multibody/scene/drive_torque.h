// What turns a shaft that runs free: a torque, or a rotor through a coupling.
#pragma once

#include <SimTKsimbody.h>

#include <functional>
#include <optional>

#include "bentaxis/pump/drive_spec.h"

namespace bentaxis::multibody {

/// The data of such a drive.
struct TorqueInTime {
  std::function<double(double time)> torque;  ///< Nm: Td, or of a motor at its speed `omega`
  std::optional<MotorData> motor;
  double omega = 0;  ///< rad/s, of [operation]
  double kept = 1;   ///< Ct: the share of Td that turns the shaft (38)
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

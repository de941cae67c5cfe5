// What turns the shaft (and the block where nothing meshes with it).
#pragma once

#include <SimTKsimbody.h>

#include <functional>

#include "bentaxis/results/instant.h"

namespace bentaxis::multibody {

/// How the shaft is turned in the dynamic scene.
enum class Drive {
  constant_speed,      ///< speed held by a constraint: integrated runs
  given_acceleration,  ///< rate of speed given: evaluation at an instant
  given_turning,       ///< angle given over time
  torque,              ///< free, under a torque
  prescribed,          ///< shaft and block prescribed: only pistons are solved for
};

/// Prescribed rotation of shaft or block: angle, speed and rate as a function of time.
struct Turning {
  double theta = 0;      ///< rad at time start
  double start = 0;      ///< s
  double omega = 0;      ///< rad/s
  double omega_dot = 0;  ///< rad/s2, at the instant; only for evaluation at time start

  double angle(double time) const { return theta + omega * (time - start); }
};

/// Angle, speed and rate of the shaft over time, where they are given.
using TurningInTime = std::function<AxisMotion(double time)>;

/// Prescribes rotation about the joint's z axis, for a pin (1 coordinate) or a ball (quaternion).
/// @param turning  must outlive the system
SimTK::Motion turning_motion(SimTK::MobilizedBody& body, const Turning& turning, bool is_ball);

/// The equation that holds the shaft's angle, its speed or its rate, where the drive has one.
class ShaftDrive {
 public:
  /// @param shaft    on a ball joint whose third speed is that about z1
  /// @param turning  of Drive::given_turning
  /// @param radius   m, at which the equation of Drive::given_turning holds the arc
  ShaftDrive(Drive drive, SimTK::MobilizedBody& shaft, double omega, const TurningInTime& turning,
             double radius);

  bool has_equation() const {
    return drive_ == Drive::constant_speed || drive_ == Drive::given_acceleration ||
           drive_ == Drive::given_turning;
  }
  /// Whether it is the last of all constraint equations of a scene and its multiplier a torque.
  bool has_torque_as_last_multiplier() const {
    return has_equation() && drive_ != Drive::given_turning;
  }
  void disable(SimTK::State& state) const;
  void set_acceleration(SimTK::State& state, double omega_dot) const;
  /// Torque about z1 that the equation applies to the shaft, Nm; 0 where there is none.
  /// @param state  realized to Acceleration
  double torque(const SimTK::State& state) const;

 private:
  Drive drive_;
  SimTK::Constraint::ConstantSpeed speed_;
  SimTK::Constraint::ConstantAcceleration acceleration_;
  SimTK::Constraint turning_;
  double radius_;
};

}  // namespace bentaxis::multibody

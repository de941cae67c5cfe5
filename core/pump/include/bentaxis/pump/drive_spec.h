// What turns the shaft in time, and for how long.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace bentaxis {

enum class DriveKind {
  speed,   ///< the shaft turns at a given speed
  torque,  ///< a given torque turns it
  motor,   ///< a rotor turns it through a coupling
};

/// Rotor and coupling: Td = K (phi - theta) + D (phi' - theta') and J phi'' = motor torque - Td,
/// which is torque - slope (phi' - omega), with the omega of [operation], or a curve over phi'.
struct MotorData {
  double torque_slope = 0;        ///< Nm s/rad
  double rotor_inertia = 0;       ///< J_m, kg m2
  double coupling_stiffness = 0;  ///< K, Nm/rad
  double coupling_damping = 0;    ///< D, Nm s/rad
};

/// A speed or torque over time, or a motor's torque over its speed, from a file: piecewise cubic
/// through its points, monotone between them, and constant outside its ends.
struct TimeCurve {
  std::filesystem::path file;
  std::vector<double> time;   ///< s, or rad/s of a motor; strictly increasing; empty: no curve
  std::vector<double> value;  ///< rad/s or Nm
};

/// The [drive] of a case. At the start theta = psi = 0, every body turns at `start_speed`, and the
/// coupling of a motor carries `torque`, or nothing where the start is from rest.
struct DriveSpec {
  DriveKind kind = DriveKind::speed;
  double torque = 0;  ///< Nm; of a motor at its speed omega
  std::optional<MotorData> motor;
  std::optional<double> start_speed;  ///< rad/s; none: omega of [operation]
  TimeCurve curve;  ///< of the speed or the torque over time, of a motor over its speed, instead
  double duration = 0;  ///< s
  int samples = 1;      ///< rows at 0, duration/samples, .., duration
};

}  // namespace bentaxis

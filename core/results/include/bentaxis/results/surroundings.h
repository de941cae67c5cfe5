// What acts on a pump from outside of its case: what a system simulator gives it as it goes.
#pragma once

#include <optional>

#include "bentaxis/pump/drive_spec.h"
#include "bentaxis/results/instant.h"

namespace bentaxis {

/// Given from outside from one moment on, until it is given anew; what is not given is as the case
/// says. A drive of kind "speed" takes `shaft`, one of kind "torque" takes `torque`.
struct Surroundings {
  /// Motion of the shaft at `time`: angle rad, speed rad/s, acceleration rad/s2. At another time t
  /// the acceleration is the same, the speed is speed + acceleration (t - time), and the angle
  /// follows likewise.
  std::optional<AxisMotion> shaft;
  double time = 0;  ///< s, at which `shaft` is what it says
  /// The shaft's motion at another time, s, where it is given.
  AxisMotion shaft_at(double at) const;
  std::optional<double> torque;  ///< Nm, on the shaft
  /// Pa gauge. Of an ideal trace both ports; of a hydraulic case the tank (or charge supply), and
  /// the delivery side where the case holds it at a pressure.
  std::optional<double> suction, delivery;
  std::optional<double> load_share;  ///< of the load's size, as the curve of [load] has it; >= 0
  /// What is given changes by so much a second from `time` on.
  double torque_rate = 0, suction_rate = 0, delivery_rate = 0, load_share_rate = 0;
  bool pressures_are_held() const;  ///< suction and delivery do not change
  /// What is given, at another time, s.
  std::optional<double> torque_at(double at) const;
  std::optional<double> suction_at(double at) const;
  std::optional<double> delivery_at(double at) const;
  std::optional<double> load_share_at(double at) const;
};

bool operator==(const Surroundings& a, const Surroundings& b);
inline bool operator!=(const Surroundings& a, const Surroundings& b) { return !(a == b); }

/// Which of them a case takes.
struct TakesFromOutside {
  bool shaft = false, torque = false;
  bool suction = false, delivery = false, load_share = false;
};

/// @throws InputError where a case's drive takes neither what is given
void require_drive(const DriveSpec& drive, const Surroundings& outside);

}  // namespace bentaxis

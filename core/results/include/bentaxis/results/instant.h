// One instant of a running pump: the argument of both models.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/pump/pressure.h"

namespace bentaxis {

/// How a body turns about its own fixed axis.
struct AxisMotion {
  double angle = 0;         ///< rad
  double speed = 0;         ///< rad/s
  double acceleration = 0;  ///< rad/s2
};

inline bool operator==(const AxisMotion& a, const AxisMotion& b) {
  return a.angle == b.angle && a.speed == b.speed && a.acceleration == b.acceleration;
}

/// How far the shaft's teeth are ahead of the block's, theta - psi of the teeth.
struct ToothLag {
  double angle = 0;  ///< rad, from the middle of the backlash
  double rate = 0;   ///< rad/s
};

/// Motion of shaft and block, and pressures, at an instant. Constant speed is the instant without
/// accelerations. Reused from call to call without allocation.
struct Instant {
  AxisMotion shaft;                      ///< theta, positive about +z1
  AxisMotion block;                      ///< psi, positive about +z2
  std::vector<double> chamber_pressure;  ///< Pa gauge, one per piston
  PortPressures ports;                   ///< Pa gauge, load the port-plate lands
  /// Where the contact is that of teeth: how they stand to each other. None: as they rest under the
  /// torque that carries the block round, which micrometres of lag decide.
  std::optional<ToothLag> lag = {};

  /// Turns shaft and block alike: the block is locked to the shaft.
  void turn(double angle, double speed, double acceleration = 0) {
    shaft = block = {angle, speed, acceleration};
  }
  /// Whether the block turns exactly as the shaft does.
  bool locked() const { return shaft == block; }
};

/// @throws InputError naming `model` where the block is not locked: for models of a block that
/// is locked to the shaft.
void require_locked(const Instant& instant, const char* model);

}  // namespace bentaxis

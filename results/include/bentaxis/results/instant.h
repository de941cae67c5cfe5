// One instant of a running pump: the argument of both models.
#pragma once

#include <vector>

#include "bentaxis/pump/pressure.h"

namespace bentaxis {

/// State of the shaft and pressures at an instant. Reused from call to call without allocation.
struct Instant {
  double theta = 0;                      ///< shaft angle, rad, positive about +z1
  double omega = 0;                      ///< rad/s
  double omega_dot = 0;                  ///< rad/s2; block and shaft turn alike
  std::vector<double> chamber_pressure;  ///< Pa gauge, one per piston
  PortPressures ports;                   ///< Pa gauge, load the port-plate lands
};

}  // namespace bentaxis

// The walls of bores that tapered pistons touch, as an integration sees them. Internal.
#pragma once

#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"
#include "closed_form/wall.h"
#include "prepared.h"

namespace bentaxis::analytic::simulation {

/// Approach of a piston and its wall, with two derivatives with respect to time.
struct WallPath {
  double distance = 0, rate = 0, rate_dot = 0;  // m, m/s, m/s2
};

class Walls {
 public:
  Walls(const PumpParameters& pump, const Assumptions& assumptions)
      : pump_(prepare(pump, assumptions)) {}

  /// Of every piston; the accelerations are those of the instant.
  void find(const Instant& instant, std::vector<WallPath>& paths) const;
  /// Force at rest, N, negative below 0: that of the law continued.
  double spring(double distance) const {
    return closed_form::wall_spring(pump_.numbers.wall, distance);
  }
  double exponent() const { return pump_.numbers.wall.exponent; }
  double dissipation() const { return pump_.numbers.wall.dissipation; }
  /// Torque about z2 of a wall, over its force, m.
  double arm() const { return pump_.numbers.wall.share * pump_.numbers.piston.bore_radius; }
  /// Torque about z2 per angle, Nm/rad, of one wall where it carries a torque, Nm.
  double torsional_stiffness(double torque) const;

 private:
  PreparedPump pump_;
};

}  // namespace bentaxis::analytic::simulation

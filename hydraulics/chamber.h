// Volume of a chamber over the angle of its piston.
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis::hydraulics {

/// V(theta) = V0 + A (max z_B - z_B(theta)): least where the piston is deepest in. Derived here
/// from the raw geometry, so that neither mechanical model is needed.
class Chamber {
 public:
  /// @param dead_volume  V0, m3
  Chamber(const Geometry& geometry, double dead_volume);

  struct Volume {
    double value = 0;  ///< m3
    double slope = 0;  ///< dV/dtheta, m3 per rad
  };
  /// At the chamber's own angle theta_k, rad.
  Volume volume(double theta) const;

  /// Piston area x stroke, m3: largest minus least volume.
  double swept() const { return area_ * (highest_ - lowest_); }

 private:
  // z_B but for a constant, as a function of u = cos(theta) alone, and its derivative.
  struct Height {
    double value = 0, slope = 0;
  };
  Height height(double u) const;

  // z_B = rise_ u + root, root^2 = length^2 - (c0_ + c1_ u + c2_ u^2).
  double rise_, length_squared_, c0_, c1_, c2_;
  double area_, dead_volume_;
  double highest_ = 0, lowest_ = 0;
};

}  // namespace bentaxis::hydraulics

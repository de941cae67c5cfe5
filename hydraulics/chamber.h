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
  /// At the chamber's own angle theta_k, rad: shaft and block turn alike.
  Volume volume(double theta) const;

  struct Turned {
    double value = 0;     ///< m3
    double by_joint = 0;  ///< dV/dtheta, m3 per rad
    double by_bore = 0;   ///< dV/dpsi
  };
  /// The joint, which turns with the shaft, at theta_k and the bore at psi_k, rad.
  Turned volume(double theta, double psi) const;

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
  // Of the joint's circle, seen along the block's axis: half axes and centre; radius of the bores'.
  double joint_across_, joint_along_, joint_centre_, bore_radius_;
  double area_, dead_volume_;
  double highest_ = 0, lowest_ = 0;
};

}  // namespace bentaxis::hydraulics

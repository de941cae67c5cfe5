// Volume of a chamber over the angle of its piston.
#pragma once

#include <optional>

#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/periodic_spline.h"

namespace bentaxis::hydraulics {

/// V(theta) = V0 + A (max z_B - z_B(theta)): least where the piston is deepest in. Derived here
/// from the raw geometry, so that neither mechanical model is needed.
///
/// Or V follows a stroke table: V0 + A (s - min s) of a stroke s, or a volume itself, by the
/// periodic cubic spline through its points, so that dV/dtheta has a continuous slope.
class Chamber {
 public:
  /// @param dead_volume  V0, m3
  Chamber(const Geometry& geometry, double dead_volume);
  /// @param stroke  followed where it has points
  Chamber(const Geometry& geometry, double dead_volume, const StrokeTable& stroke);

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
  /// The joint, which turns with the shaft, at theta_k and the bore at psi_k, rad. Not of a stroke
  /// table: it has one angle.
  Turned volume(double theta, double psi) const;

  /// Piston area x stroke, m3: largest minus least volume.
  double swept() const { return area_ * (highest_ - lowest_); }
  /// The least volume, m3.
  double dead() const { return dead_volume_; }
  /// Whether it follows a stroke table.
  bool is_given() const { return given_.has_value(); }

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
  std::optional<PeriodicSpline> given_;  // of what `area_` makes a volume
};

}  // namespace bentaxis::hydraulics

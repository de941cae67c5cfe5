// Kinematics of the pistons as derivatives with respect to the shaft angle (3.1, (7)-(18)).
// Internal.
#pragma once

#include <Eigen/Core>

#include "bentaxis/pump/parameters.h"
#include "closed_form/piston.h"

namespace bentaxis::analytic {

/// A point or direction with its first and second derivative with respect to theta, in S2.
/// Velocity is first * omega, acceleration second * omega^2 + first * omega_dot.
struct Motion {
  Eigen::Vector3d value, first, second;
};

/// Where a piston is.
struct PistonKinematics {
  Motion joint;  ///< A from O2 (9), m
  Motion axis;   ///< vector from A to B (not normalised; length b1), m
  Eigen::Vector3d ring() const { return joint.value + axis.value; }  ///< B (10)-(12), m
};

/// Kinematics of any piston of a pump. Cheap to copy.
class Kinematics {
 public:
  explicit Kinematics(const Geometry& geometry);

  /// State of the piston whose joint stands at the angle with this sine and cosine.
  PistonKinematics piston(double sine, double cosine) const;

  /// R12 of (7): components in S1 of a vector given in S2.
  Eigen::Vector3d to_s1(const Eigen::Vector3d& v2) const {
    return {v2.x(), frame_.cos_tilt * v2.y() + frame_.sin_tilt * v2.z(),
            frame_.cos_tilt * v2.z() - frame_.sin_tilt * v2.y()};
  }
  /// Components in S2 of a vector given in S1.
  Eigen::Vector3d to_s2(const Eigen::Vector3d& v1) const {
    return {v1.x(), frame_.cos_tilt * v1.y() - frame_.sin_tilt * v1.z(),
            frame_.cos_tilt * v1.z() + frame_.sin_tilt * v1.y()};
  }
  /// Orthonormal axes of S3 in S1 for a piston along `axis` (in S2): columns i3, j3, k3. j3 lies in
  /// the plane of y1 and z1 as in (15), without the division of (17) that fails at k3_y = 0.
  Eigen::Matrix3d s3_in_s1(const Eigen::Vector3d& axis) const;

 private:
  closed_form::FrameNumbers<double> frame_;
  closed_form::PistonNumbers<double> piston_;  // of the geometry only
};

}  // namespace bentaxis::analytic

#include "bentaxis/analytic/kinematics.h"

#include <Eigen/Geometry>
#include <cmath>

namespace bentaxis::analytic {
namespace {

// Rd - Ra cos(alpha), without the cancellation that cos(alpha) next to 1 brings.
double projected_difference(const Geometry& g) {
  const double half = std::sin(g.tilt / 2);
  return (g.bore_circle_radius - g.joint_circle_radius) + 2 * g.joint_circle_radius * half * half;
}

}  // namespace

Kinematics::Kinematics(const Geometry& g)
    : joint_radius_(g.joint_circle_radius),
      length_squared_(g.piston_length * g.piston_length),
      sin_tilt_(std::sin(g.tilt)),
      cos_tilt_(std::cos(g.tilt)),
      radius_difference_(g.bore_circle_radius - g.joint_circle_radius),
      radius_projected_(projected_difference(g)),
      offset_y_(g.axis_offset * sin_tilt_),
      offset_z_(-g.axis_offset * cos_tilt_) {}

PistonKinematics Kinematics::piston(double s, double c) const {
  const double yr = joint_radius_ * cos_tilt_;
  const double zr = joint_radius_ * sin_tilt_;
  PistonKinematics k;
  k.joint.value = {-joint_radius_ * s, yr * c + offset_y_, zr * c + offset_z_};
  k.joint.first = {-joint_radius_ * c, -yr * s, -zr * s};
  k.joint.second = {joint_radius_ * s, -yr * c, -zr * c};

  // AB = (x, y, h): x and y from the two circles, h the positive root of (12), differentiated
  // twice through x^2 + y^2 + h^2 = b1^2.
  const double x = -radius_difference_ * s;
  const double y = radius_projected_ * c - offset_y_;
  const double x1 = -radius_difference_ * c;
  const double y1 = -radius_projected_ * s;
  const double x2 = radius_difference_ * s;
  const double y2 = -radius_projected_ * c;
  const double h = std::sqrt(length_squared_ - x * x - y * y);
  const double h1 = -(x * x1 + y * y1) / h;
  const double h2 = -(x1 * x1 + x * x2 + y1 * y1 + y * y2 + h1 * h1) / h;
  k.axis.value = {x, y, h};
  k.axis.first = {x1, y1, h1};
  k.axis.second = {x2, y2, h2};
  return k;
}

Eigen::Matrix3d Kinematics::s3_in_s1(const Eigen::Vector3d& axis) const {
  const Eigen::Vector3d k3 = to_s1(axis).normalized();
  const Eigen::Vector3d j3 = Eigen::Vector3d(0, k3.z(), -k3.y()) / std::hypot(k3.y(), k3.z());
  Eigen::Matrix3d axes;
  axes << j3.cross(k3), j3, k3;
  return axes;
}

}  // namespace bentaxis::analytic

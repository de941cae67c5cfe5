#include "kinematics.h"

#include <Eigen/Geometry>
#include <cmath>

namespace bentaxis::analytic {
namespace {

Eigen::Vector3d to_eigen(const closed_form::Vec3<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace

Kinematics::Kinematics(const Geometry& geometry) : frame_{}, piston_{} {
  closed_form::prepare(closed_form::raw(geometry), frame_);
  closed_form::prepare(closed_form::raw(geometry), frame_, piston_);
}

PistonKinematics Kinematics::piston(double s, double c) const {
  const auto m = closed_form::piston_motion(frame_, piston_, s, c);
  return {{to_eigen(m.joint), to_eigen(m.joint_first), to_eigen(m.joint_second)},
          {to_eigen(m.axis), to_eigen(m.axis_first), to_eigen(m.axis_second)}};
}

Eigen::Matrix3d Kinematics::s3_in_s1(const Eigen::Vector3d& axis) const {
  const Eigen::Vector3d k3 = to_s1(axis).normalized();
  const Eigen::Vector3d j3 = Eigen::Vector3d(0, k3.z(), -k3.y()) / std::hypot(k3.y(), k3.z());
  Eigen::Matrix3d axes;
  axes << j3.cross(k3), j3, k3;
  return axes;
}

}  // namespace bentaxis::analytic

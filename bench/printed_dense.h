// The printed formulation solved densely: the baseline of the kernel's benchmark. At every angle
// five unknowns per piston ((33): force along x2, y2, z2 and moment along x2, y2 about A), six of
// the block ((57)) and six of the shaft ((44)), each by LU with Eigen. Kinematics, loads and
// matrices that do not depend on the angle are prepared as in the model itself, so that the ratio
// measures what solving the equations as printed costs.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <vector>

#include "bentaxis/results/instant.h"
#include "prepared.h"

namespace bentaxis::bench {

class PrintedDense {
 public:
  PrintedDense(const PumpParameters& pump, const Assumptions& assumptions)
      : prepared_(analytic::prepare(pump, assumptions)), pump_(pump) {}

  /// Reactions at an instant, ordered by ChannelLayout. Allocates nothing.
  void reactions(const Instant& t, std::vector<double>& out) const {
    using analytic::closed_form::Vec3;
    using V = Eigen::Vector3d;
    const auto eigen = [](const Vec3<double>& v) { return V(v.x, v.y, v.z); };
    const auto& p = prepared_.numbers;
    const auto common = prepared_.common();
    const double st = std::sin(t.shaft.angle);
    const double ct = std::cos(t.shaft.angle);
    const double sign = t.shaft.speed < 0 ? -1 : 1;
    V block_force(0, p.block.force_y,
                  p.block.force_z + p.film.delivery.force_z * t.ports.delivery +
                      p.film.suction.force_z * t.ports.suction);
    V block_moment(
        p.block.moment_x + p.film.delivery.moment_x * t.ports.delivery +
            p.film.suction.moment_x * t.ports.suction,
        p.film.delivery.moment_y * t.ports.delivery + p.film.suction.moment_y * t.ports.suction,
        -p.block.viscous * t.shaft.speed - p.block.inertia * t.shaft.acceleration);
    V shaft_force(0, p.shaft.force_y, p.shaft.force_z);
    V shaft_moment(p.shaft.moment_x, 0,
                   -p.shaft.viscous * t.shaft.speed - p.shaft.inertia * t.shaft.acceleration);
    Eigen::Matrix3d r12;
    r12 << 1, 0, 0, 0, p.frame.cos_tilt, p.frame.sin_tilt, 0, -p.frame.sin_tilt, p.frame.cos_tilt;
    for (int k = 0; k < common.pistons; ++k) {
      const double s = st * common.phase_cos[k] - ct * common.phase_sin[k];
      const double c = ct * common.phase_cos[k] + st * common.phase_sin[k];
      const auto m = analytic::closed_form::piston_motion(p.frame, p.piston, s, c);
      const double velocity = m.ring_velocity(t.shaft.speed);
      const double friction = analytic::closed_form::friction_force(common.friction, p.friction,
                                                                    velocity, t.shaft.speed);
      const V axis = eigen(m.axis);
      const V joint = eigen(m.joint);
      const V acc_a = eigen(m.joint_second) * t.shaft.speed * t.shaft.speed +
                      eigen(m.joint_first) * t.shaft.acceleration;
      const V acc_ab = eigen(m.axis_second) * t.shaft.speed * t.shaft.speed +
                       eigen(m.axis_first) * t.shaft.acceleration;
      const V axial(0, 0, friction - p.piston.area * t.chamber_pressure[k]);
      const V fall = V(0, p.piston.gravity_y, p.piston.gravity_z) - acc_a;
      const V force = axial + p.piston.mass * fall - p.piston.static_moment * acc_ab;
      const V moment = axis.cross(axial) +
                       axis.cross(p.piston.static_moment * fall - p.piston.inertia * acc_ab) -
                       p.piston.spin_momentum * t.shaft.speed * eigen(m.axis_first);
      Eigen::Matrix<double, 5, 5> a = Eigen::Matrix<double, 5, 5>::Zero();
      a(0, 0) = a(1, 1) = a(2, 2) = a(0, 3) = a(1, 4) = 1;
      a(3, 4) = -axis.z();
      a(4, 3) = axis.z();
      Eigen::Matrix<double, 5, 1> right;
      right << -force, -moment.head<2>();
      const Eigen::Matrix<double, 5, 1> x = a.partialPivLu().solve(right);
      for (int i = 0; i < 5; ++i) out[5 * k + i] = x[i];

      const V on_block(-x[3], -x[4], p.block.bottom_area * t.chamber_pressure[k] - friction);
      block_force += on_block;
      block_moment += (joint + axis).cross(on_block);
      const V on_shaft = -(r12 * x.head<3>());
      shaft_force += on_shaft;
      shaft_moment += V(-p.piston.joint_radius * s, p.piston.joint_radius * c, 0).cross(on_shaft);
    }
    const int at = 5 * common.pistons;
    {
      Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
      a(2, 0) = a(3, 1) = a(4, 2) = a(0, 3) = a(1, 4) = 1;
      a(4, 3) = p.block.pin_z;
      a(3, 4) = -p.block.pin_z;
      const V line = sign * V(p.gear.line_x, p.gear.line_y2, p.gear.line_z2);
      a.block<3, 1>(0, 5) = line;
      a.block<3, 1>(3, 5) = V(0, p.gear.y, p.gear.z2).cross(line);
      Eigen::Matrix<double, 6, 1> right;
      right << -block_force, -block_moment;
      const Eigen::Matrix<double, 6, 1> x = a.partialPivLu().solve(right);
      for (int i = 0; i < 6; ++i) out[at + i] = x[i];
    }
    const V tooth = -out[at + 5] * sign * V(p.gear.line_x, p.gear.line_y1, p.gear.line_z1);
    shaft_force += tooth;
    shaft_moment += V(0, p.gear.y, p.gear.z1).cross(tooth);
    Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
    a(0, 0) = a(1, 1) = a(2, 2) = a(0, 3) = a(1, 4) = 1;
    a(4, 0) = p.shaft.tapered_z;
    a(3, 1) = -p.shaft.tapered_z;
    a(4, 3) = pump_.bearings.cylindrical_z;
    a(3, 4) = -pump_.bearings.cylindrical_z;
    a(5, 5) = pump_.friction.shaft_torque_factor;
    Eigen::Matrix<double, 6, 1> right;
    right << -shaft_force, -shaft_moment;
    const Eigen::Matrix<double, 6, 1> x = a.partialPivLu().solve(right);
    for (int i = 0; i < 6; ++i) out[at + 6 + i] = x[i];
  }

 private:
  analytic::PreparedPump prepared_;
  PumpParameters pump_;
};

}  // namespace bentaxis::bench

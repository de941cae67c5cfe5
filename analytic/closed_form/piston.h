// One piston: motion (9)-(12), (23), loads (24)-(28) and the forces that hold it (29)-(33).
#pragma once

#include "bentaxis/pump/parameters.h"
#include "closed_form/frame.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// In S2.
template <class T>
struct PistonNumbers {
  T joint_radius, joint_y, joint_z;         // Ra, Ra cos(alpha), Ra sin(alpha)
  T difference, projected, length_squared;  // Rd - Ra, Rd - Ra cos(alpha), b1^2
  T area;
  T gravity_y, gravity_z;
  // About A: mass, static moment m sG / b1, inertia (It + m sG^2) / b1^2 and spin momentum
  // Ia w_s / b1, each for use with the vector AB instead of the unit vector.
  T mass, static_moment, inertia, spin_momentum;
};

/// Fills in what the motion needs.
void prepare(const Geometry& geometry, const FrameNumbers<double>& frame,
             PistonNumbers<double>& piston);
/// Fills in mass and gravity. @throws InputError if the pump has no data of such pistons.
void prepare(const PumpParameters& pump, PistonInertia inertia, const FrameNumbers<double>& frame,
             PistonNumbers<double>& piston);

/// Joint A from O2 and axis AB, in S2, with derivatives with respect to theta.
template <class Real>
struct PistonMotion {
  Vec3<Real> joint, joint_first, joint_second;
  Vec3<Real> axis, axis_first, axis_second;

  /// Velocity of B along z2.
  BENTAXIS_INLINE Real ring_velocity(const Real& omega) const {
    return (joint_first.z + axis_first.z) * omega;
  }
};

/// Positions (7)-(12) and their derivatives for the piston at the angle with this sine and cosine.
template <class Par, class Real>
BENTAXIS_INLINE PistonMotion<Real> piston_motion(const FrameNumbers<Par>& frame,
                                                 const PistonNumbers<Par>& p, const Real& s,
                                                 const Real& c) {
  PistonMotion<Real> m;
  const Real ax = p.joint_radius * s;
  const Real ay = p.joint_y * c;
  const Real az = p.joint_z * c;
  m.joint = {-ax, ay + frame.offset_y, az + frame.offset_z};
  m.joint_first = {-(p.joint_radius * c), -(p.joint_y * s), -(p.joint_z * s)};
  m.joint_second = {ax, -ay, -az};
  // AB = (x, y, h): x and y from the two circles, h the positive root of (12), differentiated
  // twice through x^2 + y^2 + h^2 = b1^2.
  const Real x = -(p.difference * s);
  const Real yc = p.projected * c;
  const Real y = yc - frame.offset_y;
  const Real x1 = -(p.difference * c);
  const Real y1 = -(p.projected * s);
  const Real h = Math<Real>::root(p.length_squared - x * x - y * y);
  const Real inverse = 1.0 / h;
  const Real h1 = -(x * x1 + y * y1) * inverse;
  const Real h2 = -(x1 * x1 - x * x + y1 * y1 - y * yc + h1 * h1) * inverse;
  m.axis = {x, y, h};
  m.axis_first = {x1, y1, h1};
  m.axis_second = {-x, -yc, h2};
  return m;
}

/// Forces on one piston.
template <class Real>
struct PistonForces {
  Vec3<Real> joint_acceleration, axis_acceleration;
  Real axial;  // Fp + Fpf, along z2 at B
  Vec3<Real> rs;
  Real rc_x, rc_y;
};

/// Loads of a piston and the forces that hold it (24)-(33). `friction` is Fpf along z2.
template <class Par, class Real>
BENTAXIS_INLINE PistonForces<Real> piston_forces(const PistonNumbers<Par>& p,
                                                 const PistonMotion<Real>& m, const Real& omega,
                                                 const Real& omega_dot, const Real& friction,
                                                 const Real& pressure) {
  PistonForces<Real> f;
  const Real omega2 = omega * omega;
  f.joint_acceleration = omega2 * m.joint_second + omega_dot * m.joint_first;
  f.axis_acceleration = omega2 * m.axis_second + omega_dot * m.axis_first;
  f.axial = friction - p.area * pressure;

  const Vec3<Real> free_fall = {-f.joint_acceleration.x, p.gravity_y - f.joint_acceleration.y,
                                p.gravity_z - f.joint_acceleration.z};
  // Weight, inertia and gyroscopic moment about A (26)-(28), appendix.
  const Vec3<Real> load = p.static_moment * free_fall - p.inertia * f.axis_acceleration;
  const Vec3<Real> moment = cross(m.axis, load) - (p.spin_momentum * omega) * m.axis_first;
  // Moment equilibrium about A gives Rc (32), force equilibrium gives Rs (31).
  const Real inverse = 1.0 / m.axis.z;
  f.rc_x = (m.axis.x * f.axial - moment.y) * inverse;
  f.rc_y = (m.axis.y * f.axial + moment.x) * inverse;
  f.rs = p.static_moment * f.axis_acceleration - p.mass * free_fall;
  f.rs.x = f.rs.x - f.rc_x;
  f.rs.y = f.rs.y - f.rc_y;
  f.rs.z = f.rs.z - f.axial;
  return f;
}

}  // namespace bentaxis::analytic::closed_form

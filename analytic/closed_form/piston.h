// One piston: motion (9)-(12), (23), loads (24)-(28) and the forces that hold it (29)-(33).
#pragma once

#include "bentaxis/pump/parameters.h"
#include "closed_form/frame.h"
#include "closed_form/state.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// In S2.
template <class T>
struct PistonNumbers {
  T joint_radius, joint_y, joint_z;         // Ra, Ra cos(alpha), Ra sin(alpha)
  T difference, projected, length_squared;  // Rd - Ra, Rd - Ra cos(alpha), b1^2
  T bore_radius;                            // Rd
  T area;
  T inverse_lever;  // b1 / s_C: Rc acts at C, s_C from A
  T gravity_y, gravity_z;
  // About A: mass, static moment m sG / b1, inertia (It + m sG^2) / b1^2 and spin momentum
  // Ia w_s / b1, each for use with the vector AB instead of the unit vector.
  T mass, static_moment, inertia, spin_momentum;
};

/// Fills in what the motion needs.
template <class T>
void prepare(const RawGeometry<T>& geometry, const FrameNumbers<T>& frame,
             PistonNumbers<T>& piston);
/// Fills in mass and gravity. The pump has the data of such pistons.
template <class T>
void prepare(const RawPump<T>& pump, PistonInertia inertia, const FrameNumbers<T>& frame,
             PistonNumbers<T>& piston);

/// Joint A from O2 and axis AB, in S2, with derivatives with respect to the parameter of the
/// motion: theta, or time where the block moves on its own (state.h).
template <class Real>
struct PistonMotion {
  Vec3<Real> joint, joint_first, joint_second;
  Vec3<Real> axis, axis_first, axis_second;

  /// Velocity of B along z2; `rate` is that of the parameter.
  BENTAXIS_INLINE Real ring_velocity(const Real& rate) const {
    return (joint_first.z + axis_first.z) * rate;
  }
};

/// Positions (7)-(12) and their derivatives with respect to theta for the piston at the angle with
/// this sine and cosine.
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

template <class Par, class Real>
BENTAXIS_INLINE PistonMotion<Real> piston_motion(const FrameNumbers<Par>& frame,
                                                 const PistonNumbers<Par>& p, const State<Real>&,
                                                 const Real& s, const Real& c) {
  return piston_motion(frame, p, s, c);
}

/// The piston whose joint stands at the angle theta_k with this sine and cosine and its bore at
/// psi_k; derivatives with respect to time. x and y are those of a locked block and what the bore
/// has moved on its own, so that a small lead keeps its digits.
template <class Par, class Real>
BENTAXIS_INLINE PistonMotion<Real> piston_motion(const FrameNumbers<Par>& frame,
                                                 const PistonNumbers<Par>& p,
                                                 const FreeState<Real>& t, const Real& s,
                                                 const Real& c) {
  PistonMotion<Real> m;
  // s + ds and c + dc: sine and cosine of psi_k.
  const Real ds = c * t.lead_sine - s * t.lead_versine;
  const Real dc = -(s * t.lead_sine + c * t.lead_versine);
  const Real w = t.omega;
  const Real v = t.block_omega;
  const Real dv = v - w;
  // First and second derivatives of s, c, ds and dc.
  const Real s1 = c * w;
  const Real c1 = -(s * w);
  const Real s2 = c * t.omega_dot - s * (w * w);
  const Real c2 = -(s * t.omega_dot + c * (w * w));
  const Real ds1 = dc * v + c * dv;
  const Real dc1 = -(ds * v + s * dv);
  const Real dw = t.block_omega_dot - t.omega_dot;
  const Real dvv = dv * (v + w);
  const Real ds2 = dc * t.block_omega_dot + c * dw - (ds * (v * v) + s * dvv);
  const Real dc2 = -(ds * t.block_omega_dot + s * dw + dc * (v * v) + c * dvv);

  m.joint = {-(p.joint_radius * s), p.joint_y * c + frame.offset_y, p.joint_z * c + frame.offset_z};
  m.joint_first = {-(p.joint_radius * s1), p.joint_y * c1, p.joint_z * c1};
  m.joint_second = {-(p.joint_radius * s2), p.joint_y * c2, p.joint_z * c2};
  const Real x = -(p.difference * s + p.bore_radius * ds);
  const Real y = p.projected * c + p.bore_radius * dc - frame.offset_y;
  const Real x1 = -(p.difference * s1 + p.bore_radius * ds1);
  const Real y1 = p.projected * c1 + p.bore_radius * dc1;
  const Real x2 = -(p.difference * s2 + p.bore_radius * ds2);
  const Real y2 = p.projected * c2 + p.bore_radius * dc2;
  const Real h = Math<Real>::root(p.length_squared - x * x - y * y);
  const Real inverse = 1.0 / h;
  const Real h1 = -(x * x1 + y * y1) * inverse;
  const Real h2 = -(x1 * x1 + x * x2 + y1 * y1 + y * y2 + h1 * h1) * inverse;
  m.axis = {x, y, h};
  m.axis_first = {x1, y1, h1};
  m.axis_second = {x2, y2, h2};
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

/// Loads of a piston and the forces that hold it (24)-(33). `rate` and `rate_dot` are those of the
/// motion's parameter, `friction` is Fpf along z2.
template <class Par, class Real>
BENTAXIS_INLINE PistonForces<Real> piston_forces(const PistonNumbers<Par>& p,
                                                 const PistonMotion<Real>& m, const Real& rate,
                                                 const Real& rate_dot, const Real& friction,
                                                 const Real& pressure) {
  PistonForces<Real> f;
  const Real rate2 = rate * rate;
  f.joint_acceleration = rate2 * m.joint_second + rate_dot * m.joint_first;
  f.axis_acceleration = rate2 * m.axis_second + rate_dot * m.axis_first;
  f.axial = friction - p.area * pressure;

  const Vec3<Real> free_fall = {-f.joint_acceleration.x, p.gravity_y - f.joint_acceleration.y,
                                p.gravity_z - f.joint_acceleration.z};
  // Weight, inertia and gyroscopic moment about A (26)-(28), appendix.
  const Vec3<Real> load = p.static_moment * free_fall - p.inertia * f.axis_acceleration;
  const Vec3<Real> moment = cross(m.axis, load) - (p.spin_momentum * rate) * m.axis_first;
  // Moment equilibrium about A gives Rc (32), with C = A + s_C e its point, force equilibrium gives
  // Rs (31).
  const Real inverse = p.inverse_lever / m.axis.z;
  f.rc_x = (m.axis.x * f.axial - moment.y) * inverse;
  f.rc_y = (m.axis.y * f.axial + moment.x) * inverse;
  f.rs = p.static_moment * f.axis_acceleration - p.mass * free_fall;
  f.rs.x = f.rs.x - f.rc_x;
  f.rs.y = f.rs.y - f.rc_y;
  f.rs.z = f.rs.z - f.axial;
  return f;
}

}  // namespace bentaxis::analytic::closed_form

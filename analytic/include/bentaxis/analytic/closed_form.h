// The closed-form algebra of the model, written once: for one instant (Real = double) and for
// several in SIMD lanes (Real = a vector; lanes are instants, or pumps where Par is a vector too).
//
// Internal: included by the model and by one translation unit per instruction set. Everything is
// inlined, because a function shared by translation units of different instruction sets would be
// linked in the version of any of them. Equation numbers: Roccatello & Nervegna (2009).
#pragma once

#include <cmath>

namespace bentaxis::analytic::closed_form {

#define BENTAXIS_INLINE [[gnu::always_inline]] inline

template <class T>
struct Vec3 {
  T x, y, z;
};
template <class T>
BENTAXIS_INLINE Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
BENTAXIS_INLINE Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T, class S>
BENTAXIS_INLINE Vec3<T> operator*(const S& s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
BENTAXIS_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The functions beyond arithmetic that the algebra needs. Vectors of lanes specialise it.
template <class Real>
struct Math {
  static Real root(Real x) { return std::sqrt(x); }
  static Real magnitude(Real x) { return std::abs(x); }
  static Real tangent(Real x) { return std::tanh(x); }
  /// 1 or -1; 1 for 0.
  static Real direction(Real x) { return x < 0 ? Real(-1) : Real(1); }
  /// The sign of x, 0 where |x| <= rest.
  static Real sign(Real x, Real rest) { return magnitude(x) <= rest ? Real(0) : direction(x); }
};

/// Numbers of a pump, prepared once, SI; in S2 unless said otherwise. Plain numbers only, so that
/// many pumps can be laid out with one array per number.
template <class T>
struct Pump {
  T joint_radius, joint_y, joint_z;          // Ra, Ra cos(alpha), Ra sin(alpha)
  T difference, projected, length_squared;   // Rd - Ra, Rd - Ra cos(alpha), b1^2
  T sin_tilt, cos_tilt, offset_y, offset_z;  // offset: O1 from O2
  T piston_area, bottom_area;
  T gravity_y, gravity_z;
  // Friction (25): coulomb (tanh(v / v_reg) + dry sign(v)) + viscous v; one of 1/v_reg and dry is
  // 0.
  T coulomb, viscous, inverse_regularization, dry;
  // A piston about A: mass, static moment m sG / b1, inertia (It + m sG^2) / b1^2 and spin momentum
  // Ia w_s / b1, each for use with the vector AB instead of the unit vector.
  T mass, static_moment, inertia, spin_momentum;
  T block_force_y, block_force_z, block_moment_x;  // weight and spring on the block, about O2
  T block_inertia, block_viscous, pin_z;
  T delivery_force, delivery_moment_x, delivery_moment_y;  // land force per pascal
  T suction_force, suction_moment_x, suction_moment_y;
  // O4 and k4 for omega >= 0, in S1 and S2; x is common.
  T gear_y, gear_z1, gear_z2, line_x, line_y1, line_z1, line_y2, line_z2, inverse_gear_arm;
  T shaft_force_y, shaft_force_z,
      shaft_moment_x;  // weight and spring on the shaft, about O1, in S1
  T shaft_inertia, shaft_viscous, inverse_torque_factor;
  T tapered_z, inverse_bearing_distance;
};

/// What all pumps of a batch have in common.
struct Common {
  int pistons = 0;
  const double* phase_sin = nullptr;  ///< of 2 pi k / N
  const double* phase_cos = nullptr;
  bool imposed = false;          ///< block speed imposed: no tooth force
  bool smooth_friction = false;  ///< some pump has a tanh law
  bool dry_friction = false;     ///< some pump has a sign law
};

/// Instant without the chamber pressures.
template <class Real>
struct State {
  Real sine, cosine;  // of theta
  Real omega, omega_dot;
  Real suction, delivery;
};

/// A piston's joint A from O2 and its axis AB, in S2, with derivatives with respect to theta.
template <class Real>
struct PistonMotion {
  Vec3<Real> joint, joint_first, joint_second;
  Vec3<Real> axis, axis_first, axis_second;
};

/// Forces on one piston.
template <class Real>
struct PistonForces {
  Vec3<Real> joint_acceleration, axis_acceleration;
  Real friction, axial;  // Fpf; Fp + Fpf, along z2 at B
  Vec3<Real> rs;
  Real rc_x, rc_y;
};

template <class Par, class Real>
BENTAXIS_INLINE Vec3<Real> to_s1(const Pump<Par>& p, const Vec3<Real>& v) {
  return {v.x, p.cos_tilt * v.y + p.sin_tilt * v.z, p.cos_tilt * v.z - p.sin_tilt * v.y};
}

/// Positions (7)-(12) and their derivatives for the piston at the angle with this sine and cosine.
template <class Par, class Real>
BENTAXIS_INLINE PistonMotion<Real> piston_motion(const Pump<Par>& p, const Real& s, const Real& c) {
  PistonMotion<Real> m;
  const Real ax = p.joint_radius * s;
  const Real ay = p.joint_y * c;
  const Real az = p.joint_z * c;
  m.joint = {-ax, ay + p.offset_y, az + p.offset_z};
  m.joint_first = {-(p.joint_radius * c), -(p.joint_y * s), -(p.joint_z * s)};
  m.joint_second = {ax, -ay, -az};
  // AB = (x, y, h): x and y from the two circles, h the positive root of (12), differentiated
  // twice through x^2 + y^2 + h^2 = b1^2.
  const Real x = -(p.difference * s);
  const Real yc = p.projected * c;
  const Real y = yc - p.offset_y;
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

/// Friction force Fpf on a piston whose ring moves with `velocity` along z2 (25).
template <class Par, class Real>
BENTAXIS_INLINE Real friction_force(const Common& common, const Pump<Par>& p, const Real& velocity,
                                    const Real& omega) {
  Real force = p.viscous * velocity;
  if (common.smooth_friction)
    force = force + p.coulomb * Math<Real>::tangent(velocity * p.inverse_regularization);
  if (common.dry_friction) {
    const Real rest = 1e-12 * p.joint_radius * Math<Real>::magnitude(omega);
    force = force + p.coulomb * p.dry * Math<Real>::sign(velocity, rest);
  }
  return -force;
}

/// Loads of a piston and the forces that hold it (24)-(33).
template <class Par, class Real>
BENTAXIS_INLINE PistonForces<Real> piston_forces(const Common& common, const Pump<Par>& p,
                                                 const PistonMotion<Real>& m, const Real& omega,
                                                 const Real& omega_dot, const Real& pressure) {
  PistonForces<Real> f;
  const Real omega2 = omega * omega;
  f.joint_acceleration = omega2 * m.joint_second + omega_dot * m.joint_first;
  f.axis_acceleration = omega2 * m.axis_second + omega_dot * m.axis_first;
  const Real velocity = (m.joint_first.z + m.axis_first.z) * omega;
  f.friction = friction_force(common, p, velocity, omega);
  f.axial = f.friction - p.piston_area * pressure;

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

/// Bearing forces that hold a force and a moment about O1 on the shaft (42), (43), in S1.
template <class Real>
struct BearingForces {
  Vec3<Real> tapered;
  Real cylindrical_x, cylindrical_y;
};
template <class Par, class Real>
BENTAXIS_INLINE BearingForces<Real> bearings(const Pump<Par>& p, const Vec3<Real>& force,
                                             const Real& moment_x, const Real& moment_y) {
  BearingForces<Real> b;
  b.cylindrical_x = (p.tapered_z * force.x - moment_y) * p.inverse_bearing_distance;
  b.cylindrical_y = (p.tapered_z * force.y + moment_x) * p.inverse_bearing_distance;
  b.tapered = {-force.x - b.cylindrical_x, -force.y - b.cylindrical_y, -force.z};
  return b;
}

/// All reactions at an instant: pistons (31)-(33), block (56), (57), shaft (42), (43).
/// @param pressure  pressure(k): of chamber k
/// @param put       put(index, value): result, indexed as ChannelLayout orders the reactions; Rcs
/// is
///                  not put where the block speed is imposed
/// @param bodies    false: pistons only
template <class Par, class Real, class Pressure, class Put>
BENTAXIS_INLINE void reactions(const Common& common, const Pump<Par>& p, const State<Real>& t,
                               bool bodies, const Pressure& pressure, const Put& put) {
  const Real zero = 0.0;
  Real bore_x = zero, bore_y = zero, axial = zero;                   // on the block (56)
  Vec3<Real> block_moment = {zero, zero, zero};                      // about O2 (57)
  Vec3<Real> joint_force = {zero, zero, zero};                       // sum of Rs, in S2
  Real joint_moment_x = zero, joint_moment_y = zero, torque = zero;  // of Rs about O1, in S1
  for (int k = 0; k < common.pistons; ++k) {
    const double ps = common.phase_sin[k];
    const double pc = common.phase_cos[k];
    const Real s = t.sine * pc - t.cosine * ps;
    const Real c = t.cosine * pc + t.sine * ps;
    const Real chamber = pressure(k);
    const PistonMotion<Real> m = piston_motion(p, s, c);
    const PistonForces<Real> f = piston_forces(common, p, m, t.omega, t.omega_dot, chamber);
    put(5 * k, f.rs.x);
    put(5 * k + 1, f.rs.y);
    put(5 * k + 2, f.rs.z);
    put(5 * k + 3, f.rc_x);
    put(5 * k + 4, f.rc_y);
    if (!bodies) continue;

    const Vec3<Real> ring = m.joint + m.axis;
    const Real push = p.bottom_area * chamber - f.friction;
    bore_x = bore_x + f.rc_x;
    bore_y = bore_y + f.rc_y;
    axial = axial + push;
    block_moment.x = block_moment.x + (ring.z * f.rc_y + ring.y * push);
    block_moment.y = block_moment.y - (ring.z * f.rc_x + ring.x * push);
    block_moment.z = block_moment.z + (ring.y * f.rc_x - ring.x * f.rc_y);
    // A in S1 is Ra (-s, c, 0).
    const Vec3<Real> rs1 = to_s1(p, f.rs);
    joint_force = joint_force + f.rs;
    joint_moment_x = joint_moment_x + c * rs1.z;
    joint_moment_y = joint_moment_y + s * rs1.z;
    torque = torque - (s * rs1.y + c * rs1.x);
  }
  if (!bodies) return;
  const int at = 5 * common.pistons;

  // Block. About z2 (57): the torque that carries it round.
  Vec3<Real> force = {
      -bore_x, p.block_force_y - bore_y,
      axial + p.block_force_z + p.delivery_force * t.delivery + p.suction_force * t.suction};
  Real moment_x = block_moment.x + p.block_moment_x + p.delivery_moment_x * t.delivery +
                  p.suction_moment_x * t.suction;
  Real moment_y =
      block_moment.y + p.delivery_moment_y * t.delivery + p.suction_moment_y * t.suction;
  Real tooth = zero;  // along k4 for omega >= 0, on the block
  if (!common.imposed) {
    tooth = (p.block_inertia * t.omega_dot + p.block_viscous * t.omega - block_moment.z) *
            p.inverse_gear_arm;
    put(at + 5, Math<Real>::direction(t.omega) * tooth);
    const Vec3<Real> on_block = {p.line_x * tooth, p.line_y2 * tooth, p.line_z2 * tooth};
    force = force + on_block;
    moment_x = moment_x + (p.gear_y * on_block.z - p.gear_z2 * on_block.y);
    moment_y = moment_y + p.gear_z2 * on_block.x;
  }
  const Real pin_x = -force.x;
  const Real pin_y = -force.y;
  put(at, -force.z);
  put(at + 1, p.pin_z * pin_y - moment_x);
  put(at + 2, -(p.pin_z * pin_x) - moment_y);
  put(at + 3, pin_x);
  put(at + 4, pin_y);

  // Shaft.
  const Vec3<Real> joints = to_s1(p, joint_force);
  const Vec3<Real> on_shaft = {-(p.line_x * tooth), -(p.line_y1 * tooth), -(p.line_z1 * tooth)};
  force = {on_shaft.x - joints.x, on_shaft.y - joints.y + p.shaft_force_y,
           on_shaft.z - joints.z + p.shaft_force_z};
  moment_x = p.gear_y * on_shaft.z - p.gear_z1 * on_shaft.y - p.joint_radius * joint_moment_x +
             p.shaft_moment_x;
  moment_y = p.gear_z1 * on_shaft.x - p.joint_radius * joint_moment_y;
  const Real moment_z = -(p.gear_y * on_shaft.x) - p.joint_radius * torque;
  const BearingForces<Real> held = bearings(p, force, moment_x, moment_y);
  put(at + 6, held.tapered.x);
  put(at + 7, held.tapered.y);
  put(at + 8, held.tapered.z);
  put(at + 9, held.cylindrical_x);
  put(at + 10, held.cylindrical_y);
  put(at + 11, (p.shaft_inertia * t.omega_dot + p.shaft_viscous * t.omega - moment_z) *
                   p.inverse_torque_factor);  // (38), (43)
}

}  // namespace bentaxis::analytic::closed_form

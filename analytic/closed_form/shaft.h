// The shaft: what pistons and gear do to it, its bearings (39), (40), (42) and its drive torque
// (38), (41), (43).
#pragma once

#include "closed_form/frame.h"
#include "closed_form/gear.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

template <class T>
struct ShaftNumbers {
  T joint_radius;                // Ra
  T force_y, force_z, moment_x;  // weight and spring, about O1, in S1
  T inertia, viscous, inverse_torque_factor;
  T tapered_z, inverse_bearing_distance;
  T axis_offset;  // b: z1 of O2
};

template <class T>
void prepare(const RawPump<T>& pump, const FrameNumbers<T>& frame, ShaftNumbers<T>& p);

/// Sums of Rs over the pistons.
template <class Real>
struct ShaftLoad {
  Vec3<Real> force;                 // in S2
  Real moment_x, moment_y, torque;  // about O1 in S1, over Ra
};

/// Adds Rs of the piston whose joint stands at the angle with this sine and cosine: A is
/// Ra (-s, c, 0) in S1.
template <class Par, class Real>
BENTAXIS_INLINE void add_joint(const FrameNumbers<Par>& frame, const Vec3<Real>& rs, const Real& s,
                               const Real& c, ShaftLoad<Real>& load) {
  const Vec3<Real> rs1 = to_s1(frame, rs);
  load.force = load.force + rs;
  load.moment_x = load.moment_x + c * rs1.z;
  load.moment_y = load.moment_y + s * rs1.z;
  load.torque = load.torque - (s * rs1.y + c * rs1.x);
}

/// Bearing forces that hold a force and a moment about O1 on the shaft (42), in S1.
template <class Real>
struct BearingForces {
  Vec3<Real> tapered;
  Real cylindrical_x, cylindrical_y;
};
template <class Par, class Real>
BENTAXIS_INLINE BearingForces<Real> bearings(const ShaftNumbers<Par>& p, const Vec3<Real>& force,
                                             const Real& moment_x, const Real& moment_y) {
  BearingForces<Real> b;
  b.cylindrical_x = (p.tapered_z * force.x - moment_y) * p.inverse_bearing_distance;
  b.cylindrical_y = (p.tapered_z * force.y + moment_x) * p.inverse_bearing_distance;
  b.tapered = {-force.x - b.cylindrical_x, -force.y - b.cylindrical_y, -force.z};
  return b;
}

/// Bearing forces of the shaft under its pistons and the gear.
template <class Par, class Real>
BENTAXIS_INLINE BearingForces<Real> hold_shaft(const FrameNumbers<Par>& frame,
                                               const ShaftNumbers<Par>& p,
                                               const ShaftLoad<Real>& load,
                                               const ToothForce<Real>& tooth) {
  const Vec3<Real> joints = to_s1(frame, load.force);
  const Vec3<Real> force = {tooth.force.x - joints.x, tooth.force.y - joints.y + p.force_y,
                            tooth.force.z - joints.z + p.force_z};
  const Real moment_x = tooth.moment.x - p.joint_radius * load.moment_x + p.moment_x;
  const Real moment_y = tooth.moment.y - p.joint_radius * load.moment_y;
  return bearings(p, force, moment_x, moment_y);
}

/// Drive torque (38), (43).
template <class Par, class Real>
BENTAXIS_INLINE Real drive_torque(const ShaftNumbers<Par>& p, const ShaftLoad<Real>& load,
                                  const ToothForce<Real>& tooth, const Real& omega,
                                  const Real& omega_dot) {
  const Real moment_z = tooth.moment.z - p.joint_radius * load.torque;
  return (p.inertia * omega_dot + p.viscous * omega - moment_z) * p.inverse_torque_factor;
}

}  // namespace bentaxis::analytic::closed_form

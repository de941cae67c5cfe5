// The cylinder block: what the pistons do to it, and its equilibrium (56), (57).
#pragma once

#include "closed_form/piston.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

template <class T>
struct BlockNumbers {
  T bottom_area;
  T force_y, force_z, moment_x;  // weight and spring, about O2, in S2
  T inertia, viscous, pin_z;
  T contact;  // s_C / b1
};

template <class T>
void prepare(const RawPump<T>& pump, const PistonNumbers<T>& piston, BlockNumbers<T>& p);

/// C, the point of a piston's axis where the bore force acts (32), from O2.
template <class Par, class Real>
BENTAXIS_INLINE Vec3<Real> contact_point(const BlockNumbers<Par>& p, const PistonMotion<Real>& m) {
  return m.joint + p.contact * m.axis;
}

/// Sums over the pistons.
template <class Real>
struct BlockLoad {
  Real bore_x, bore_y, axial;
  Vec3<Real> moment;  // about O2
};

template <class Par, class Real>
BENTAXIS_INLINE void add_piston(const BlockNumbers<Par>& p, const PistonMotion<Real>& m,
                                const PistonForces<Real>& f, const Real& friction,
                                const Real& pressure, BlockLoad<Real>& load) {
  const Vec3<Real> ring = m.joint + m.axis;
  const Vec3<Real> contact = contact_point(p, m);
  const Real push = p.bottom_area * pressure - friction;
  load.bore_x = load.bore_x + f.rc_x;
  load.bore_y = load.bore_y + f.rc_y;
  load.axial = load.axial + push;
  load.moment.x = load.moment.x + (contact.z * f.rc_y + ring.y * push);
  load.moment.y = load.moment.y - (contact.z * f.rc_x + ring.x * push);
  load.moment.z = load.moment.z + (contact.y * f.rc_x - contact.x * f.rc_y);
}

/// Torque about z2 that must carry the block round (57), at its speed and acceleration.
template <class Par, class Real>
BENTAXIS_INLINE Real carrying_torque(const BlockNumbers<Par>& p, const BlockLoad<Real>& load,
                                     const Real& speed, const Real& acceleration) {
  return p.inertia * acceleration + p.viscous * speed - load.moment.z;
}

/// Force on the block and moment about x2 and y2 at O2.
template <class Real>
struct BlockBalance {
  Vec3<Real> force;
  Real moment_x, moment_y;
};

/// Pistons, weight and spring.
template <class Par, class Real>
BENTAXIS_INLINE BlockBalance<Real> block_balance(const BlockNumbers<Par>& p,
                                                 const BlockLoad<Real>& load) {
  return {{-load.bore_x, p.force_y - load.bore_y, load.axial + p.force_z},
          load.moment.x + p.moment_x,
          load.moment.y};
}

/// What holds the block across z2 and along it: pin and film.
template <class Real>
struct BlockReactions {
  Real fh, th_x, th_y;
  Real pin_x, pin_y;
};
template <class Par, class Real>
BENTAXIS_INLINE BlockReactions<Real> hold_block(const BlockNumbers<Par>& p,
                                                const BlockBalance<Real>& b) {
  BlockReactions<Real> r;
  r.pin_x = -b.force.x;
  r.pin_y = -b.force.y;
  r.fh = -b.force.z;
  r.th_x = p.pin_z * r.pin_y - b.moment_x;
  r.th_y = -(p.pin_z * r.pin_x) - b.moment_y;
  return r;
}

}  // namespace bentaxis::analytic::closed_form

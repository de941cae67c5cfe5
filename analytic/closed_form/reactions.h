// The closed-form algebra of the model, written once: for one instant (Real = double) and for
// several in SIMD lanes (Real = a vector; lanes are instants, or pumps where Par is a vector too).
// This file composes the pieces that lie beside it. Equation numbers: Roccatello & Nervegna (2009).
#pragma once

#include <type_traits>

#include "bentaxis/results/quantities.h"
#include "closed_form/pump.h"
#include "closed_form/transfer.h"

namespace bentaxis::analytic::closed_form {

/// All reactions at an instant: pistons (31)-(33), block (56), (57), shaft (42), (43).
/// @param pressure  pressure(k): of chamber k
/// @param put       put(column, value): result, in the columns of ChannelLayout; Rcs is not put
///                  where the block speed is imposed
/// @param bodies    false: pistons only
/// @param moved     moved(k, motion, forces): of each piston
/// @param t         what the transfer constrains: State of a block that a gear locks to the shaft,
///                  FreeState of one that moves on its own, JointState, CardanState,
///                  DoubleCardanState, or WallState
template <class Real, class Par, class Turning, class Pressure, class Put, class Moved>
BENTAXIS_INLINE void reactions(const Common& common, const Pump<Par>& p, const Turning& t,
                               bool bodies, const Pressure& pressure, const Put& put,
                               const Moved& moved) {
  using Q = Quantity;
  const int n = common.pistons;
  const Real zero = 0.0;
  BlockLoad<Real> on_block = {zero, zero, zero, {zero, zero, zero}};
  ShaftLoad<Real> on_shaft = {{zero, zero, zero}, zero, zero, zero};
  for (int k = 0; k < n; ++k) {
    const double ps = common.phase_sin[k];
    const double pc = common.phase_cos[k];
    const Real s = t.sine * pc - t.cosine * ps;
    const Real c = t.cosine * pc + t.sine * ps;
    const Real chamber = pressure(k);
    const PistonMotion<Real> m = piston_motion(p.frame, p.piston, t, s, c);
    const Real friction =
        friction_force(common.friction, p.friction, m.ring_velocity(t.rate()), t.omega);
    PistonForces<Real> f = piston_forces(p.piston, m, t.rate(), t.rate_dot(), friction, chamber);
    moved(k, m, f);
    if constexpr (std::is_same_v<Turning, WallState<Real>>) {
      const WallApproach<Real> at = wall_approach(p.wall, m, common.clearance(p.wall, k));
      const Real wall = wall_force(p.wall, at, t.mode(k));
      if (common.wall_column >= 0) {
        put(common.wall_column + 2 * k, wall * at.x);
        put(common.wall_column + 2 * k + 1, wall * at.y);
      }
      add_wall(p.wall, m, wall * at.x, wall * at.y, f, on_block);
    }
    put_all<Q::Rs>(put, n, k, f.rs.x, f.rs.y, f.rs.z);
    put_all<Q::Rc>(put, n, k, f.rc_x, f.rc_y);
    if (!bodies) continue;
    add_piston(p.block, m, f, friction, chamber, on_block);
    add_joint(p.frame, f.rs, s, c, on_shaft);
  }
  if (!bodies) return;

  BlockBalance<Real> balance = block_balance(p.block, on_block);
  add_lands(p.film, t.delivery, t.suction, balance);
  const auto carried = carry<Real>(common, p, t, on_block, balance, put);
  const BlockReactions<Real> block = hold_block(p.block, balance);
  put_all<Q::Fh>(put, n, 0, block.fh);
  put_all<Q::Th>(put, n, 0, block.th_x, block.th_y);
  put_all<Q::Rcn>(put, n, 0, block.pin_x, block.pin_y);

  const ToothForce<Real> carrying = carried.on_shaft(p);
  const BearingForces<Real> held = hold_shaft(p.frame, p.shaft, on_shaft, carrying);
  put_all<Q::Rb1>(put, n, 0, held.tapered.x, held.tapered.y, held.tapered.z);
  put_all<Q::Rb2>(put, n, 0, held.cylindrical_x, held.cylindrical_y);
  put_all<Q::Td>(put, n, 0, drive_torque(p.shaft, on_shaft, carrying, t.omega, t.omega_dot));
}

template <class Real, class Par, class Turning, class Pressure, class Put>
BENTAXIS_INLINE void reactions(const Common& common, const Pump<Par>& p, const Turning& t,
                               bool bodies, const Pressure& pressure, const Put& put) {
  reactions<Real>(common, p, t, bodies, pressure, put,
                  [](int, const PistonMotion<Real>&, const PistonForces<Real>&) {});
}

}  // namespace bentaxis::analytic::closed_form

// The closed-form algebra of the model, written once: for one instant (Real = double) and for
// several in SIMD lanes (Real = a vector; lanes are instants, or pumps where Par is a vector too).
// This file composes the pieces that lie beside it. Equation numbers: Roccatello & Nervegna (2009).
#pragma once

#include <type_traits>

#include "bentaxis/results/quantities.h"
#include "closed_form/pump.h"

namespace bentaxis::analytic::closed_form {

/// Column of a quantity in a row of results; fixed when compiled but for the number of pistons.
template <Quantity quantity>
BENTAXIS_INLINE int column(int pistons, int piston, int component) {
  constexpr QuantityPlace kHere = quantity_place(static_cast<std::size_t>(quantity));
  return kHere.per_piston * pistons + kHere.single + kHere.stride * piston + component;
}

/// Gives put() the components of a quantity.
template <Quantity quantity, class Put, class... Real>
BENTAXIS_INLINE void put_all(const Put& put, int pistons, int piston, const Real&... values) {
  static_assert(sizeof...(values) == quantity_place(static_cast<std::size_t>(quantity)).components);
  int component = 0;
  (put(column<quantity>(pistons, piston, component++), values), ...);
}

/// What carries the block round: on block and shaft.
template <class Real>
struct Carried {
  ToothForce<Real> on_block, on_shaft;
};

/// The transfer's share of the reactions: `torque` about z2 carries the block round. Puts the
/// columns of its own.
template <class Real, class Par, class Turning, class Put>
BENTAXIS_INLINE Carried<Real> carry(const Common& common, const Pump<Par>& p, const Turning& t,
                                    const Real& torque, const Put& put) {
  const Real zero = 0.0;
  const Vec3<Real> none = {zero, zero, zero};
  if (common.transfer == TransferKind::gear) {
    Real tooth = zero;  // on the block, positive towards +psi
    if (!common.imposed) {
      tooth = torque * p.gear.inverse_arm;
      put_all<Quantity::Rcs>(put, common.pistons, 0, Math<Real>::direction(t.omega) * tooth);
    }
    return {tooth_on_block(p.gear, tooth), tooth_on_shaft(p.gear, tooth)};
  }
  if (common.transfer == TransferKind::pistons) {
    // Their forces are among the loads: what is left comes from outside.
    if (common.block_torque_column >= 0) put(common.block_torque_column, torque);
    return {{none, none}, {none, none}};
  }
  const Couple<Real> joint = couple(p.joint, t, torque);
  if (common.couple_column >= 0) {
    put(common.couple_column, joint.on_block.x);
    put(common.couple_column + 1, joint.on_block.y);
    put(common.couple_column + 2, joint.on_block.z);
  }
  return {{none, joint.on_block}, {none, joint.on_shaft}};
}

/// All reactions at an instant: pistons (31)-(33), block (56), (57), shaft (42), (43).
/// @param pressure  pressure(k): of chamber k
/// @param put       put(column, value): result, in the columns of ChannelLayout; Rcs is not put
///                  where the block speed is imposed
/// @param bodies    false: pistons only
/// @param t         State, or FreeState of a block that moves on its own, CardanState of one that a
///                  universal joint turns, WallState of one that pistons carry round
template <class Real, class Par, class Turning, class Pressure, class Put>
BENTAXIS_INLINE void reactions(const Common& common, const Pump<Par>& p, const Turning& t,
                               bool bodies, const Pressure& pressure, const Put& put) {
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
    if constexpr (std::is_same_v<Turning, WallState<Real>>) {
      const WallApproach<Real> at = wall_approach(p.wall, m);
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
  const Real torque =
      carrying_torque(p.block, on_block, t.block_speed(), t.block_acceleration());
  const Carried<Real> carried = carry<Real>(common, p, t, torque, put);
  if (!common.imposed) {
    balance.force = balance.force + carried.on_block.force;
    balance.moment_x = balance.moment_x + carried.on_block.moment.x;
    balance.moment_y = balance.moment_y + carried.on_block.moment.y;
  }
  const BlockReactions<Real> block = hold_block(p.block, balance);
  put_all<Q::Fh>(put, n, 0, block.fh);
  put_all<Q::Th>(put, n, 0, block.th_x, block.th_y);
  put_all<Q::Rcn>(put, n, 0, block.pin_x, block.pin_y);

  const BearingForces<Real> held = hold_shaft(p.frame, p.shaft, on_shaft, carried.on_shaft);
  put_all<Q::Rb1>(put, n, 0, held.tapered.x, held.tapered.y, held.tapered.z);
  put_all<Q::Rb2>(put, n, 0, held.cylindrical_x, held.cylindrical_y);
  put_all<Q::Td>(put, n, 0, drive_torque(p.shaft, on_shaft, carried.on_shaft, t.omega, t.omega_dot));
}

}  // namespace bentaxis::analytic::closed_form

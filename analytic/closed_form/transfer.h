// What each transfer carries: the torque that turns the block, as it acts on block and shaft, and
// the columns of its own. Which one it is says the type of the state that it constrains.
#pragma once

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

/// The tooth force of a gear.
template <class Real>
struct ByGear {
  Real tooth;  // on the block, positive towards +psi
  template <class Par>
  BENTAXIS_INLINE ToothForce<Real> on_shaft(const Pump<Par>& p) const {
    return tooth_on_shaft(p.gear, tooth);
  }
};
/// @param t  State or FreeState
template <class Real, class Par, class Turning, class Put>
BENTAXIS_INLINE ByGear<Real> carry(const Common& common, const Pump<Par>& p, const Turning& t,
                                   const BlockLoad<Real>& on_block, BlockBalance<Real>& balance,
                                   const Put& put) {
  Real tooth = 0.0;
  if (!common.imposed) {
    tooth = carrying_torque(p.block, on_block, t.block_speed(), t.block_acceleration()) *
            p.gear.inverse_arm;
    put_all<Quantity::Rcs>(put, common.pistons, 0, Math<Real>::direction(t.omega) * tooth);
    const ToothForce<Real> carried = tooth_on_block(p.gear, tooth);
    balance.force = balance.force + carried.force;
    balance.moment_x = balance.moment_x + carried.moment.x;
    balance.moment_y = balance.moment_y + carried.moment.y;
  }
  return {tooth};
}

/// Puts the components of a vector from a column on, where it is asked for.
template <class Real, class Put>
BENTAXIS_INLINE void put_from(const Put& put, int column, const Vec3<Real>& v) {
  if (column < 0) return;
  put(column, v.x);
  put(column + 1, v.y);
  put(column + 2, v.z);
}

/// The couple of a joint.
template <class Real>
struct ByJoint {
  Couple<Real> couple;
  template <class Par>
  BENTAXIS_INLINE ToothForce<Real> on_shaft(const Pump<Par>&) const {
    const Real none = 0.0;
    return {{none, none, none}, couple.on_shaft};
  }
};
template <class Real, class Par, class Turning, class Put>
BENTAXIS_INLINE ByJoint<Real> carry_by_joint(const Common& common, const Pump<Par>& p,
                                             const Turning& t, const BlockLoad<Real>& on_block,
                                             BlockBalance<Real>& balance, const Put& put) {
  const Real torque = carrying_torque(p.block, on_block, t.block_speed(), t.block_acceleration());
  const Couple<Real> joint = couple(p.joint, t, torque);
  balance.moment_x = balance.moment_x + joint.on_block.x;
  balance.moment_y = balance.moment_y + joint.on_block.y;
  put_from(put, common.couple_column, joint.on_block);
  return {joint};
}
template <class Real, class Par, class Put>
BENTAXIS_INLINE ByJoint<Real> carry(const Common& common, const Pump<Par>& p,
                                    const JointState<Real>& t, const BlockLoad<Real>& on_block,
                                    BlockBalance<Real>& balance, const Put& put) {
  return carry_by_joint(common, p, t, on_block, balance, put);
}
template <class Real, class Par, class Put>
BENTAXIS_INLINE ByJoint<Real> carry(const Common& common, const Pump<Par>& p,
                                    const CardanState<Real>& t, const BlockLoad<Real>& on_block,
                                    BlockBalance<Real>& balance, const Put& put) {
  return carry_by_joint(common, p, t, on_block, balance, put);
}

/// The couple of two universal joints, and their force at O2.
template <class Real>
struct ByDoubleCardan {
  Couple<Real> couple;
  Vec3<Real> force;  // on the block, in S2
  template <class Par>
  BENTAXIS_INLINE ToothForce<Real> on_shaft(const Pump<Par>& p) const {
    const Vec3<Real> f = to_s1(p.frame, Vec3<Real>{-force.x, -force.y, -force.z});
    // O2 lies on z1.
    const Vec3<Real> moment = {couple.on_shaft.x - p.shaft.axis_offset * f.y,
                               couple.on_shaft.y + p.shaft.axis_offset * f.x, couple.on_shaft.z};
    return {f, moment};
  }
};
template <class Real, class Par, class Put>
BENTAXIS_INLINE ByDoubleCardan<Real> carry(const Common& common, const Pump<Par>& p,
                                           const DoubleCardanState<Real>& t,
                                           const BlockLoad<Real>& on_block,
                                           BlockBalance<Real>& balance, const Put& put) {
  const ByJoint<Real> joint = carry_by_joint(common, p, t, on_block, balance, put);
  const Vec3<Real> force = side_force(p.joint, t, joint.couple.on_block.z);
  balance.force = balance.force + force;
  put_from(put, common.force_column, force);
  return {joint.couple, force};
}

/// Walls of bores: what they do is among the loads. What is left of the block's balance comes from
/// outside.
template <class Real>
struct ByWalls {
  template <class Par>
  ToothForce<Real> on_shaft(const Pump<Par>&) const {
    return {{0, 0, 0}, {0, 0, 0}};
  }
};
template <class Real, class Par, class Put>
ByWalls<Real> carry(const Common& common, const Pump<Par>& p, const WallState<Real>& t,
                    const BlockLoad<Real>& on_block, BlockBalance<Real>&, const Put& put) {
  if (common.block_torque_column >= 0)
    put(common.block_torque_column,
        carrying_torque(p.block, on_block, t.block_speed(), t.block_acceleration()));
  return {};
}

}  // namespace bentaxis::analytic::closed_form

// An instant as the closed form takes it. Internal.
#pragma once

#include "bentaxis/results/instant.h"
#include "closed_form/pump.h"
#include "closed_form/state.h"

namespace bentaxis::analytic {

/// Calls `use` with a state of the type that a transfer has whose block follows from the shaft
/// alone: JointState, CardanState or DoubleCardanState of a joint, else State of a locked block. It
/// is to be filled; closed_form::turn_block() turns the block then.
template <class Real, class Use>
BENTAXIS_INLINE void with_shaft_state(TransferKind transfer, const Use& use) {
  const auto of_type = [&](auto state) { use(state); };
  switch (transfer) {
    case TransferKind::constant_velocity:
      return of_type(closed_form::JointState<Real>());
    case TransferKind::cardan:
      return of_type(closed_form::CardanState<Real>());
    case TransferKind::double_cardan:
      return of_type(closed_form::DoubleCardanState<Real>());
    case TransferKind::gear:
    case TransferKind::pistons:
      break;
  }
  of_type(closed_form::State<Real>());
}

/// theta'' and psi'', rad/s2.
template <class Real>
struct Accelerations {
  Real shaft, block;
};

/// Calls `use` with the state of an instant that the transfer has: closed_form::State where the
/// block is locked to the shaft; FreeState where it moves on its own; JointState, CardanState or
/// DoubleCardanState, whose block follows from the shaft alone; or WallState. The block's motion of
/// an instant is not looked at where a joint prescribes it.
/// @param by      instead of those of the instant
/// @param locked  the block turns exactly as the shaft does
/// @param modes   of the walls, where pistons carry the block; null: all by their law
template <class Real, class Par, class Use>
BENTAXIS_INLINE void with_state(TransferKind transfer, const closed_form::Pump<Par>& pump,
                                const Instant& instant, const Accelerations<Real>& by, bool locked,
                                const Use& use, const closed_form::WallMode* modes) {
  using std::sin, std::cos;
  const Real theta = instant.shaft.angle;
  const auto turn_shaft = [&](auto& state) {
    state.sine = sin(theta);
    state.cosine = cos(theta);
    state.omega = instant.shaft.speed;
    state.omega_dot = by.shaft;
    state.suction = instant.ports.suction;
    state.delivery = instant.ports.delivery;
  };
  const auto turn_block = [&](auto& state, const Real& half_lead) {
    state.lead(sin(half_lead), cos(half_lead));
    state.block_omega = instant.block.speed;
    state.block_omega_dot = by.block;
  };
  if (traits_of(transfer).joint) {
    with_shaft_state<Real>(transfer, [&](auto& state) {
      turn_shaft(state);
      closed_form::turn_block(pump.joint, state);
      use(state);
    });
    return;
  }
  if (transfer == TransferKind::pistons) {
    closed_form::WallState<Real> state;
    turn_shaft(state);
    turn_block(state, instant.lag ? Real(-instant.lag->angle) / 2
                                  : (Real(instant.block.angle) - theta) / 2);
    state.modes = modes;
    use(state);
    return;
  }
  closed_form::FreeState<Real> state;
  turn_shaft(state);
  if (locked) {
    use(static_cast<const closed_form::State<Real>&>(state));
    return;
  }
  turn_block(state, (Real(instant.block.angle) - theta) / 2);
  use(state);
}

/// The same under the accelerations of the instant.
template <class Real, class Use>
BENTAXIS_INLINE void with_state(TransferKind transfer, const closed_form::Pump<Real>& pump,
                                const Instant& instant, const Use& use) {
  with_state<Real>(transfer, pump, instant,
                   Accelerations<Real>{instant.shaft.acceleration, instant.block.acceleration},
                   instant.locked(), use, nullptr);
}

}  // namespace bentaxis::analytic

// An instant as the closed form takes it. Internal.
#pragma once

#include "bentaxis/results/instant.h"
#include "closed_form/state.h"

namespace bentaxis::analytic {

/// Calls `use` with the closed_form::State of an instant, or with the FreeState of one whose block
/// moves on its own.
template <class Real, class Use>
BENTAXIS_INLINE void with_state(const Instant& instant, const Use& use) {
  const Real theta = instant.shaft.angle;
  closed_form::FreeState<Real> state;
  state.sine = std::sin(theta);
  state.cosine = std::cos(theta);
  state.omega = instant.shaft.speed;
  state.omega_dot = instant.shaft.acceleration;
  state.suction = instant.ports.suction;
  state.delivery = instant.ports.delivery;
  if (instant.locked()) {
    use(static_cast<const closed_form::State<Real>&>(state));
    return;
  }
  const Real half_lead = (Real(instant.block.angle) - theta) / 2;
  state.lead(std::sin(half_lead), std::cos(half_lead));
  state.block_omega = instant.block.speed;
  state.block_omega_dot = instant.block.acceleration;
  use(state);
}

}  // namespace bentaxis::analytic

// How shaft and block turn at an instant, as the pieces of the closed form see it.
#pragma once

#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// Instant without the chamber pressures, of a block that is locked to the shaft. The pistons move
/// along one path; its parameter is theta.
template <class Real>
struct State {
  Real sine, cosine;  // of theta
  Real omega, omega_dot;
  Real suction, delivery;

  /// First and second derivative of the path's parameter with respect to time.
  BENTAXIS_INLINE Real rate() const { return omega; }
  BENTAXIS_INLINE Real rate_dot() const { return omega_dot; }
  BENTAXIS_INLINE Real block_speed() const { return omega; }
  BENTAXIS_INLINE Real block_acceleration() const { return omega_dot; }
};

/// Instant of a block that moves on its own, at the angle psi. The path's parameter is time.
template <class Real>
struct FreeState : State<Real> {
  Real lead_sine, lead_versine;       // sin and 1 - cos of psi - theta
  Real block_omega, block_omega_dot;  // psi', psi''

  /// `half_sine`, `half_cosine`: of (psi - theta) / 2.
  BENTAXIS_INLINE void lead(const Real& half_sine, const Real& half_cosine) {
    lead_sine = 2.0 * half_sine * half_cosine;
    lead_versine = 2.0 * half_sine * half_sine;
  }
  BENTAXIS_INLINE Real rate() const { return 1.0; }
  BENTAXIS_INLINE Real rate_dot() const { return 0.0; }
  BENTAXIS_INLINE Real block_speed() const { return block_omega; }
  BENTAXIS_INLINE Real block_acceleration() const { return block_omega_dot; }
};

}  // namespace bentaxis::analytic::closed_form

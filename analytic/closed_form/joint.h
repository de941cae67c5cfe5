// A joint between shaft and block: an ideal constant-velocity joint, one universal joint or two. It
// prescribes how the block turns and carries it round by a couple, beside which two universal
// joints exert a force at O2. Neither does work. docs/transfer.md.
#pragma once

#include "bentaxis/pump/parameters.h"
#include "closed_form/gear.h"
#include "closed_form/raw.h"
#include "closed_form/state.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

template <class T>
struct JointNumbers {
  T tan_half;               // of alpha / 2
  T force_per_torque;       // tan(alpha / 2) / d of two universal joints; 0 without them
  T sine, cosine, versine;  // sin(alpha), cos(alpha), 1 - cos(alpha)
  T phase_sine, phase_cosine;
};

template <class T>
void prepare(const RawPump<T>& pump, JointNumbers<T>& p);

/// Instant of a block that a constant-velocity joint turns as the shaft (T1).
template <class Real>
struct JointState : State<Real> {};

/// Instant of a block that a universal joint turns (T4), (T5).
template <class Real>
struct CardanState : FreeState<Real> {
  Real arm_sine, arm_cosine;  // of t = theta - phi, the angle of the shaft's fork
  Real inverse_q;             // 1 / (1 - sin(alpha)^2 sin(t)^2)
};

/// Instant of a block that two universal joints turn as the shaft (T13).
template <class Real>
struct DoubleCardanState : State<Real> {
  Real arm_sine, arm_cosine;  // of t
};

/// Turns the block of a state whose shaft is known, as far as it does not turn as the shaft, and
/// the arms of its joint.
template <class Par, class Turning>
BENTAXIS_INLINE void turn_block(const JointNumbers<Par>&, Turning&) {}
template <class Par, class Real>
BENTAXIS_INLINE void turn_block(const JointNumbers<Par>& p, DoubleCardanState<Real>& t) {
  t.arm_sine = t.sine * p.phase_cosine - t.cosine * p.phase_sine;
  t.arm_cosine = t.cosine * p.phase_cosine + t.sine * p.phase_sine;
}
template <class Par, class Real>
BENTAXIS_INLINE void turn_block(const JointNumbers<Par>& p, CardanState<Real>& t) {
  const Real s = t.sine * p.phase_cosine - t.cosine * p.phase_sine;
  const Real c = t.cosine * p.phase_cosine + t.sine * p.phase_sine;
  const Real bent = p.sine * s;
  const Real q = 1.0 - bent * bent;
  const Real inverse_root = 1.0 / Math<Real>::root(q);
  t.arm_sine = s;
  t.arm_cosine = c;
  t.inverse_q = inverse_root * inverse_root;
  // psi - theta: its sine and cosine are those of (T4) over sqrt(Q).
  t.lead_sine = -(p.versine * s * c) * inverse_root;
  const Real lead_cosine = (c * c + p.cosine * (s * s)) * inverse_root;
  t.lead_versine = t.lead_sine * t.lead_sine / (1.0 + lead_cosine);
  const Real ratio = p.cosine * t.inverse_q;
  t.block_omega = ratio * t.omega;
  t.block_omega_dot =
      ratio * (t.omega_dot + 2.0 * (bent * p.sine * c) * (t.omega * t.omega) * t.inverse_q);
}

/// Couple on the block in S2 and on the shaft in S1 that carries the block round with `torque`
/// about z2: along the bisector of both axes (T2), (T3).
template <class Real>
struct Couple {
  Vec3<Real> on_block, on_shaft;
};
template <class Par, class Real, class Turning>
BENTAXIS_INLINE Couple<Real> couple(const JointNumbers<Par>& p, const Turning&,
                                    const Real& torque) {
  const Real side = p.tan_half * torque;
  const Real none = 0.0;
  return {{none, -side, torque}, {none, -side, -torque}};
}
/// Across the cross's two arms (T6).
template <class Par, class Real>
BENTAXIS_INLINE Couple<Real> couple(const JointNumbers<Par>& p, const CardanState<Real>& t,
                                    const Real& torque) {
  const Real share = torque * t.inverse_q;
  const Real x = p.sine * t.arm_sine * t.arm_cosine * share;
  return {{-x, -(p.sine * p.cosine * t.arm_sine * t.arm_sine * share), torque},
          {x, -(p.sine * t.arm_cosine * t.arm_cosine * share), -(p.cosine * share)}};
}

/// Force at O2 on the block, in S2, beside the couple of two universal joints with `torque` about
/// z2 (T14).
template <class Par, class Real>
BENTAXIS_INLINE Vec3<Real> side_force(const JointNumbers<Par>& p, const DoubleCardanState<Real>& t,
                                      const Real& torque) {
  const Real size = p.force_per_torque * torque;
  const Real along = size * t.arm_sine * t.arm_cosine;
  return {-(size * t.arm_sine * t.arm_sine), along, p.tan_half * along};
}

}  // namespace bentaxis::analytic::closed_form

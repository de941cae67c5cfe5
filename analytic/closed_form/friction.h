// Friction between a piston's ring and its bore (25).
#pragma once

#include "closed_form/raw.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// A ring rests for the sign law where its speed is below this share of |omega| Ra: at a dead
/// centre the speed found is round-off of that product, with any sign.
inline constexpr double kRestShare = 1e-12;

/// Law coulomb (tanh(v / v_reg) + dry sign(v)) + viscous v; one of 1 / v_reg and dry is 0.
template <class T>
struct FrictionNumbers {
  T coulomb, viscous, inverse_regularization, dry;
  T rest_radius;  // kRestShare Ra: times |omega| it is the speed of a ring at rest
};

/// Which terms of the law some pump has.
struct FrictionLaw {
  bool smooth = false;  ///< tanh
  bool dry = false;     ///< sign
};

/// @param any  false: pistons without friction
template <class T>
FrictionLaw prepare(const RawPump<T>& pump, bool any, FrictionNumbers<T>& p);

/// Friction force Fpf along z2 on a piston whose ring moves with `velocity` along z2 (25).
template <class Par, class Real>
BENTAXIS_INLINE Real friction_force(const FrictionLaw& law, const FrictionNumbers<Par>& p,
                                    const Real& velocity, const Real& omega) {
  Real force = p.viscous * velocity;
  if (law.smooth)
    force = force + p.coulomb * Math<Real>::tangent(velocity * p.inverse_regularization);
  if (law.dry) {
    const Real rest = p.rest_radius * Math<Real>::magnitude(omega);
    force = force + p.coulomb * p.dry * Math<Real>::sign(velocity, rest);
  }
  return -force;
}

}  // namespace bentaxis::analytic::closed_form

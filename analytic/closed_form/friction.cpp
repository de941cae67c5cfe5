#include "closed_form/friction.h"

namespace bentaxis::analytic::closed_form {

FrictionLaw prepare(const PumpParameters& pump, bool any, FrictionNumbers<double>& p) {
  const Friction& friction = pump.friction;
  const bool smooth = friction.regularization > 0;
  p.coulomb = any ? friction.piston_coulomb : 0;
  p.viscous = any ? friction.piston_viscous : 0;
  p.inverse_regularization = smooth ? 1 / friction.regularization : 0;
  p.dry = smooth ? 0 : 1;
  p.rest_radius = kRestShare * pump.geometry.joint_circle_radius;
  return {p.coulomb > 0 && smooth, p.coulomb > 0 && !smooth};
}

}  // namespace bentaxis::analytic::closed_form

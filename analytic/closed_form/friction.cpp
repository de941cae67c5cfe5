#include "closed_form/friction.h"

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
FrictionLaw prepare(const RawPump<T>& pump, bool any, FrictionNumbers<T>& p) {
  const auto& friction = pump.friction;
  const bool smooth = friction.regularization > 0;
  p.coulomb = any ? friction.piston_coulomb : T(0);
  p.viscous = any ? friction.piston_viscous : T(0);
  p.inverse_regularization = smooth ? 1 / friction.regularization : T(0);
  p.dry = smooth ? 0 : 1;
  p.rest_radius = kRestShare * pump.geometry.joint_circle_radius;
  return {counts(p.coulomb) && smooth, counts(p.coulomb) && !smooth};
}
template FrictionLaw prepare(const RawPump<double>& pump, bool any, FrictionNumbers<double>& p);
template FrictionLaw prepare(const RawPump<Dual>& pump, bool any, FrictionNumbers<Dual>& p);
template FrictionLaw prepare(const RawPump<long double>& pump, bool any,
                             FrictionNumbers<long double>& p);

}  // namespace bentaxis::analytic::closed_form

// The gear between shaft and block: a line of action through O4 for each flank (19)-(22), (55), and
// the contact law of flanks that give way.
#pragma once

#include <optional>

#include "bentaxis/pump/parameters.h"
#include "closed_form/raw.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// O4 and k4 for omega >= 0, in S1 and S2; x is common.
template <class T>
struct GearNumbers {
  T y, z1, z2, line_x, line_y1, line_z1, line_y2, line_z2, inverse_arm;
  T two_flanks;  // 1, or 0: one line of action for either sign of the force
};

template <class T>
void prepare(const RawPump<T>& pump, Flanks flanks, GearNumbers<T>& p);

/// Force and its moment: on the block in S2 about O2, on the shaft in S1 about O1.
template <class Real>
struct ToothForce {
  Vec3<Real> force, moment;
};

/// The part of a tooth force that pushes the gears apart; exact.
template <class Par, class Real>
BENTAXIS_INLINE Real separating(const GearNumbers<Par>& p, const Real& tooth) {
  return tooth + p.two_flanks * (Math<Real>::magnitude(tooth) - tooth);
}

/// On the block; `tooth` is positive where it pushes the block towards +psi: along k4 for
/// omega >= 0.
template <class Par, class Real>
BENTAXIS_INLINE ToothForce<Real> tooth_on_block(const GearNumbers<Par>& p, const Real& tooth) {
  const Real apart = separating(p, tooth);
  const Vec3<Real> f = {p.line_x * tooth, p.line_y2 * apart, p.line_z2 * apart};
  return {f, {p.y * f.z - p.z2 * f.y, p.z2 * f.x, -(p.y * f.x)}};
}
template <class Par, class Real>
BENTAXIS_INLINE ToothForce<Real> tooth_on_shaft(const GearNumbers<Par>& p, const Real& tooth) {
  const Real apart = separating(p, tooth);
  const Vec3<Real> f = {-(p.line_x * tooth), -(p.line_y1 * apart), -(p.line_z1 * apart)};
  return {f, {p.y * f.z - p.z1 * f.y, p.z1 * f.x, -(p.y * f.x)}};
}

/// The contact law of flanks that give way, with backlash between them.
struct ToothLaw {
  double arm = 0;  ///< of the line of action about either axis, m
  double half_backlash = 0, stiffness = 0, exponent = 1, dissipation = 0;

  /// Force of a flank at this approach, m, and speed of approach, m/s.
  double flank(double approach, double speed) const;
  /// Force on the block, positive towards +psi, where the shaft is `lag` = theta - psi ahead, rad.
  double force(double lag, double lag_rate) const {
    return flank(arm * lag - half_backlash, arm * lag_rate) -
           flank(-arm * lag - half_backlash, -arm * lag_rate);
  }
};

/// None where the teeth are rigid.
std::optional<ToothLaw> tooth_law(const Gear& gear);

}  // namespace bentaxis::analytic::closed_form

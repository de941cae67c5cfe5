// The gear between shaft and block: one line of action through O4 (19)-(22), (55).
#pragma once

#include "bentaxis/pump/parameters.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// O4 and k4 for omega >= 0, in S1 and S2; x is common.
template <class T>
struct GearNumbers {
  T y, z1, z2, line_x, line_y1, line_z1, line_y2, line_z2, inverse_arm;
};

void prepare(const PumpParameters& pump, GearNumbers<double>& p);

/// Force and its moment: on the block in S2 about O2, on the shaft in S1 about O1.
template <class Real>
struct ToothForce {
  Vec3<Real> force, moment;
};

/// On the block; `tooth` is along k4 for omega >= 0.
template <class Par, class Real>
BENTAXIS_INLINE ToothForce<Real> tooth_on_block(const GearNumbers<Par>& p, const Real& tooth) {
  const Vec3<Real> f = {p.line_x * tooth, p.line_y2 * tooth, p.line_z2 * tooth};
  return {f, {p.y * f.z - p.z2 * f.y, p.z2 * f.x, -(p.y * f.x)}};
}
template <class Par, class Real>
BENTAXIS_INLINE ToothForce<Real> tooth_on_shaft(const GearNumbers<Par>& p, const Real& tooth) {
  const Vec3<Real> f = {-(p.line_x * tooth), -(p.line_y1 * tooth), -(p.line_z1 * tooth)};
  return {f, {p.y * f.z - p.z1 * f.y, p.z1 * f.x, -(p.y * f.x)}};
}

}  // namespace bentaxis::analytic::closed_form

// The frames S1 of the shaft and S2 of the block, bent by alpha (5)-(8).
#pragma once

#include "closed_form/raw.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

template <class T>
struct FrameNumbers {
  T sin_tilt, cos_tilt;
  T offset_y, offset_z;  // O1 from O2, in S2
};

template <class T>
void prepare(const RawGeometry<T>& geometry, FrameNumbers<T>& frame);

/// R12 of (7): components in S1 of a vector given in S2.
template <class Par, class Real>
BENTAXIS_INLINE Vec3<Real> to_s1(const FrameNumbers<Par>& p, const Vec3<Real>& v) {
  return {v.x, p.cos_tilt * v.y + p.sin_tilt * v.z, p.cos_tilt * v.z - p.sin_tilt * v.y};
}

}  // namespace bentaxis::analytic::closed_form

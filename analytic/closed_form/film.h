// The oil film between block and port plate: force on the lands (49). Its resultant Fh and where
// that acts follow from the block's equilibrium (51)-(53).
#pragma once

#include "closed_form/block.h"
#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// Resultant on the block per pascal of port pressure: force along z2 and moment about O2, in S2.
template <class T>
struct LandForce {
  T force_z;   // m2, negative: pushes the block off the plate
  T moment_x;  // m3
  T moment_y;  // m3
};

template <class T>
struct FilmNumbers {
  LandForce<T> delivery, suction;
};

/// Exact integral over one port: full pressure between r2 and r3, linear to 0 at r1 and r4.
template <class T>
LandForce<T> land_force(const RawPlate<T>& plate, const RawArc<T>& arc);

/// @param plate  whether the pump has one: no land force without
template <class T>
void prepare(const RawPump<T>& pump, bool plate, FilmNumbers<T>& film);

template <class Par, class Real>
BENTAXIS_INLINE void add_lands(const FilmNumbers<Par>& p, const Real& delivery, const Real& suction,
                               BlockBalance<Real>& b) {
  b.force.z = b.force.z + p.delivery.force_z * delivery + p.suction.force_z * suction;
  b.moment_x = b.moment_x + p.delivery.moment_x * delivery + p.suction.moment_x * suction;
  b.moment_y = b.moment_y + p.delivery.moment_y * delivery + p.suction.moment_y * suction;
}

}  // namespace bentaxis::analytic::closed_form

#include "closed_form/joint.h"

#include <cmath>

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
void prepare(const RawPump<T>& pump, JointNumbers<T>& p) {
  using std::cos, std::sin, std::tan;
  const T half = pump.geometry.tilt / 2;
  const T sin_half = sin(half);
  p.tan_half = tan(half);
  p.force_per_torque =
      pump.transfer.cross_distance > 0 ? p.tan_half / pump.transfer.cross_distance : T(0);
  p.sine = sin(pump.geometry.tilt);
  p.cosine = cos(pump.geometry.tilt);
  p.versine = 2 * sin_half * sin_half;
  p.phase_sine = sin(pump.transfer.phase);
  p.phase_cosine = cos(pump.transfer.phase);
}
template void prepare(const RawPump<double>& pump, JointNumbers<double>& p);
template void prepare(const RawPump<Dual>& pump, JointNumbers<Dual>& p);
template void prepare(const RawPump<long double>& pump, JointNumbers<long double>& p);

}  // namespace bentaxis::analytic::closed_form

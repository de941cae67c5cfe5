#include "closed_form/frame.h"

#include <cmath>

#include "closed_form/dual.h"

namespace bentaxis::analytic::closed_form {

template <class T>
void prepare(const RawGeometry<T>& g, FrameNumbers<T>& frame) {
  using std::cos, std::sin;
  frame.sin_tilt = sin(g.tilt);
  frame.cos_tilt = cos(g.tilt);
  frame.offset_y = g.axis_offset * frame.sin_tilt;
  frame.offset_z = -g.axis_offset * frame.cos_tilt;
}
template void prepare(const RawGeometry<double>& g, FrameNumbers<double>& frame);
template void prepare(const RawGeometry<Dual>& g, FrameNumbers<Dual>& frame);
template void prepare(const RawGeometry<long double>& g, FrameNumbers<long double>& frame);

}  // namespace bentaxis::analytic::closed_form

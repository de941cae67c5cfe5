#include "closed_form/frame.h"

#include <cmath>

namespace bentaxis::analytic::closed_form {

void prepare(const Geometry& g, FrameNumbers<double>& frame) {
  frame.sin_tilt = std::sin(g.tilt);
  frame.cos_tilt = std::cos(g.tilt);
  frame.offset_y = g.axis_offset * frame.sin_tilt;
  frame.offset_z = -g.axis_offset * frame.cos_tilt;
}

}  // namespace bentaxis::analytic::closed_form

#include "bentaxis/results/joint.h"

#include <cmath>

namespace bentaxis {

AxisMotion joint_motion(const PumpParameters& pump, const AxisMotion& shaft) {
  if (!pump.transfer.is_uneven_joint()) return shaft;
  const double t = shaft.angle - pump.transfer.phase();
  const double c = std::cos(pump.geometry.tilt), s = std::sin(pump.geometry.tilt);
  const double sin_t = std::sin(t), cos_t = std::cos(t);
  const double q = 1 - s * s * sin_t * sin_t;
  return {shaft.angle + std::atan2((c - 1) * sin_t * cos_t, cos_t * cos_t + c * sin_t * sin_t),
          c * shaft.speed / q,
          c * shaft.acceleration / q +
              c * s * s * std::sin(2 * t) * shaft.speed * shaft.speed / (q * q)};
}

}  // namespace bentaxis

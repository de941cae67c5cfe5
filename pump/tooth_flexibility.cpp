#include "bentaxis/pump/tooth_flexibility.h"

#include <algorithm>

#include "bentaxis/pump/units.h"

namespace bentaxis {

ToothFlexibility::ToothFlexibility(const Gear& gear, double /*pitch_cone*/) {
  const ToothData& teeth = *gear.teeth;
  low_ = -teeth.dedendum;
  high_ = teeth.addendum;
  const double nu = teeth.poisson_ratio;
  contact_ = 4 * (1 - nu * nu) / (kPi * teeth.youngs_modulus);
  const double scale = 1 / teeth.youngs_modulus;
  coefficients_ = {6 * scale, 4 * scale, 1 * scale};
}

double ToothFlexibility::tooth(double height) const {
  const double x =
      std::clamp((2 * height - low_ - high_) / (high_ - low_), -1.0, 1.0);  // in [-1, 1]
  double before = 0, last = 0;
  for (std::size_t i = coefficients_.size(); i-- > 1;) {
    const double now = 2 * x * last - before + coefficients_[i];
    before = last;
    last = now;
  }
  return x * last - before + coefficients_[0];
}

}  // namespace bentaxis

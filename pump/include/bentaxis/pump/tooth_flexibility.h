// How much a slice of a tooth gives way: an input that both models share, stated in docs/teeth.md.
#pragma once

#include <vector>

#include "bentaxis/pump/parameters.h"

namespace bentaxis {

/// Flexibility of a slice of a pair of teeth: deflection along the line of action per force per
/// width, m/(N/m). Each tooth is the spur tooth of the equivalent gear (Tredgold: Z / cos delta
/// teeth on the radius (d/2) / cos delta): bending, shear and compression of an involute
/// cantilever, its foundation, and Hertz' flattening of the pair. Slices do not help each other,
/// nor do neighbouring teeth. Shapes shrink towards O2 in proportion, so that flexibility is the
/// same at every distance.
class ToothFlexibility {
 public:
  /// @param pitch_cone  delta, rad
  ToothFlexibility(const Gear& gear, double pitch_cone);

  /// Of one tooth that is loaded at this height over the pitch cone, m, measured at O4.
  /// Smooth; beyond root and tip as there.
  double tooth(double height) const;
  /// Of the flattening of both, wherever they touch.
  double contact() const { return contact_; }

 private:
  double low_ = 0, high_ = 0;         // heights of root and tip, m
  std::vector<double> coefficients_;  // of Chebyshev polynomials between them
  double contact_ = 0;
};

}  // namespace bentaxis

// The worst of a series of errors.
#pragma once

#include <cmath>

namespace bentaxis {

/// Keeps the larger magnitude in `worst`. A NaN stays: std::max would drop it, and what could not
/// be computed would pass for exact.
inline void keep_worst(double& worst, double error) {
  const double size = std::abs(error);
  if (std::isnan(size) || size > worst) worst = size;
}

}  // namespace bentaxis

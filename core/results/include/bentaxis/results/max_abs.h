// The largest magnitude of a series.
#pragma once

#include <cmath>

namespace bentaxis {

/// Keeps the larger magnitude in `max_abs`. A NaN stays: std::max would drop it, and what could not
/// be computed would pass for exact.
inline void update_max_abs(double& max_abs, double value) {
  const double size = std::abs(value);
  if (std::isnan(size) || size > max_abs) max_abs = size;
}

}  // namespace bentaxis

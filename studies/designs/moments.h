// Mean and variance of draws.
#pragma once

#include <vector>

namespace bentaxis::designs {

struct Moments {
  double mean = 0, variance = 0;
};
inline Moments moments_of(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v;
  m.mean /= static_cast<double>(values.size());
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
  m.variance /= static_cast<double>(values.size() - 1);
  return m;
}

}  // namespace bentaxis::designs

// Where a function of one variable is smallest.
#pragma once

#include <boost/math/tools/minima.hpp>
#include <limits>

namespace bentaxis::numerics {

/// The place in [low, high] where a function with one minimum there is smallest, by Brent's method,
/// to half of a double's digits: nearer to its minimum a function is flat to round-off.
template <class Function>
double smallest_at(const Function& value, double low, double high) {
  constexpr int kBits = std::numeric_limits<double>::digits / 2;
  return boost::math::tools::brent_find_minima(value, low, high, kBits).first;
}

}  // namespace bentaxis::numerics

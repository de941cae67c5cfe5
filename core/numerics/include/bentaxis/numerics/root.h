// A root between two places where a function has opposite signs.
#pragma once

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bentaxis::numerics {

/// To a unit in the last place or so (Alefeld, Potra, Shi 1995, algorithm 748). Allocates nothing.
/// @param at_low, at_high  values there; their signs differ, or one is 0
template <class Function>
double root_between(const Function& value, double low, double high, double at_low, double at_high) {
  if (at_low == 0) return low;
  if (at_high == 0) return high;
  const auto near_enough = [](double a, double b) {
    return std::abs(b - a) <=
           std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
  };
  std::uintmax_t steps = 200;
  const auto [a, b] =
      boost::math::tools::toms748_solve(value, low, high, at_low, at_high, near_enough, steps);
  return std::abs(value(a)) <= std::abs(value(b)) ? a : b;
}

}  // namespace bentaxis::numerics

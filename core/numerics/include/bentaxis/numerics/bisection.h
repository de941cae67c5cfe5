// A root by halving.
#pragma once

namespace bentaxis::numerics {

struct Bracket {
  double low = 0, high = 1;
  double middle() const { return (low + high) / 2; }
};

/// Halves a bracket a given number of times: is_above(x) says of the middle whether the root lies
/// below it. The result depends on that alone, to the last bit.
template <class IsAbove>
Bracket bisect(Bracket bracket, int halvings, const IsAbove& is_above) {
  for (int i = 0; i < halvings; ++i) {
    const double middle = bracket.middle();
    (is_above(middle) ? bracket.high : bracket.low) = middle;
  }
  return bracket;
}

}  // namespace bentaxis::numerics

// Two numbers side by side, for the closed form at one instant under two accelerations.
#pragma once

#include <cmath>

#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// Each operation is that of both numbers; on most processors it is one instruction.
struct Pair {
  using Both = double __attribute__((vector_size(16)));
  Both both;

  Pair() = default;
  Pair(double value) : both{value, value} {}  // NOLINT(google-explicit-constructor): as double
  Pair(double first, double second) : both{first, second} {}
  BENTAXIS_INLINE explicit Pair(const Both& values) : both(values) {}

  BENTAXIS_INLINE double first() const { return both[0]; }
  BENTAXIS_INLINE double second() const { return both[1]; }
};

BENTAXIS_INLINE Pair operator+(const Pair& a, const Pair& b) { return Pair(a.both + b.both); }
BENTAXIS_INLINE Pair operator-(const Pair& a, const Pair& b) { return Pair(a.both - b.both); }
BENTAXIS_INLINE Pair operator*(const Pair& a, const Pair& b) { return Pair(a.both * b.both); }
BENTAXIS_INLINE Pair operator/(const Pair& a, const Pair& b) { return Pair(a.both / b.both); }
BENTAXIS_INLINE Pair operator-(const Pair& a) { return Pair(-a.both); }

/// Once where both numbers are the same, as positions and speeds are.
template <class Function>
BENTAXIS_INLINE Pair of_both(const Pair& x, const Function& f) {
  const double first = f(x.first());
  return {first, x.second() == x.first() ? first : f(x.second())};
}
BENTAXIS_INLINE Pair sin(const Pair& x) {
  return of_both(x, [](double v) { return std::sin(v); });
}
BENTAXIS_INLINE Pair cos(const Pair& x) {
  return of_both(x, [](double v) { return std::cos(v); });
}

template <>
struct Math<Pair> {
  BENTAXIS_INLINE static Pair root(const Pair& x) {
    return {std::sqrt(x.first()), std::sqrt(x.second())};
  }
  BENTAXIS_INLINE static Pair magnitude(const Pair& x) {
    return {std::abs(x.first()), std::abs(x.second())};
  }
  BENTAXIS_INLINE static Pair tangent(const Pair& x) {
    return of_both(x, [](double v) { return std::tanh(v); });
  }
  BENTAXIS_INLINE static Pair direction(const Pair& x) {
    return {Math<double>::direction(x.first()), Math<double>::direction(x.second())};
  }
  BENTAXIS_INLINE static Pair sign(const Pair& x, const Pair& rest) {
    return {Math<double>::sign(x.first(), rest.first()),
            Math<double>::sign(x.second(), rest.second())};
  }
};

}  // namespace bentaxis::analytic::closed_form

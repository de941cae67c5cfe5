// A number with its derivatives along some directions: goes through the closed form as a number
// does.
#pragma once

#include <array>
#include <cmath>

#include "closed_form/vector.h"

namespace bentaxis::analytic::closed_form {

/// Directions that are carried at a time: two registers of the processor's least set.
inline constexpr int kDirections = 4;

struct Dual {
  using Rates = std::array<double, kDirections>;
  double value;
  Rates rate;

  Dual() = default;
  Dual(double number) : value(number), rate{} {}
  Dual(double number, const Rates& rates) : value(number), rate(rates) {}
};

/// f(a), with the derivative of f at a.
BENTAXIS_INLINE Dual chain(double f, double slope, const Dual& a) {
  Dual r(f);
  for (int i = 0; i < kDirections; ++i) r.rate[i] = slope * a.rate[i];
  return r;
}
/// f(a, b), with both its derivatives.
BENTAXIS_INLINE Dual chain(double f, double by_a, const Dual& a, double by_b, const Dual& b) {
  Dual r(f);
  for (int i = 0; i < kDirections; ++i) r.rate[i] = by_a * a.rate[i] + by_b * b.rate[i];
  return r;
}

BENTAXIS_INLINE Dual operator-(const Dual& a) { return chain(-a.value, -1, a); }
BENTAXIS_INLINE Dual operator+(const Dual& a, const Dual& b) {
  return chain(a.value + b.value, 1, a, 1, b);
}
BENTAXIS_INLINE Dual operator-(const Dual& a, const Dual& b) {
  return chain(a.value - b.value, 1, a, -1, b);
}
BENTAXIS_INLINE Dual operator*(const Dual& a, const Dual& b) {
  return chain(a.value * b.value, b.value, a, a.value, b);
}
BENTAXIS_INLINE Dual operator/(const Dual& a, const Dual& b) {
  const double quotient = a.value / b.value;
  return chain(quotient, 1 / b.value, a, -quotient / b.value, b);
}
BENTAXIS_INLINE Dual operator*(double a, const Dual& b) { return chain(a * b.value, a, b); }
BENTAXIS_INLINE Dual operator*(const Dual& a, double b) { return b * a; }
BENTAXIS_INLINE bool operator>(const Dual& a, double b) { return a.value > b; }

BENTAXIS_INLINE Dual sin(const Dual& a) { return chain(std::sin(a.value), std::cos(a.value), a); }
BENTAXIS_INLINE Dual cos(const Dual& a) { return chain(std::cos(a.value), -std::sin(a.value), a); }
BENTAXIS_INLINE Dual tan(const Dual& a) {
  const double t = std::tan(a.value);
  return chain(t, 1 + t * t, a);
}

/// Whether a parameter that must not be negative counts: it is not 0, or is varied from 0.
template <class T>
bool counts(const T& parameter) {
  return parameter > 0;
}
inline bool counts(const Dual& parameter) {
  for (const double rate : parameter.rate)
    if (rate != 0) return true;
  return parameter.value > 0;
}

template <>
struct Math<Dual> {
  BENTAXIS_INLINE static Dual root(const Dual& x) {
    const double r = std::sqrt(x.value);
    return chain(r, 0.5 / r, x);
  }
  BENTAXIS_INLINE static Dual magnitude(const Dual& x) { return x.value < 0 ? -x : x; }
  BENTAXIS_INLINE static Dual tangent(const Dual& x) {
    const double t = std::tanh(x.value);
    const double c = std::cosh(x.value);
    return chain(t, 1 / (c * c), x);
  }
  BENTAXIS_INLINE static Dual direction(const Dual& x) { return x.value < 0 ? -1.0 : 1.0; }
  BENTAXIS_INLINE static Dual sign(const Dual& x, const Dual& rest) {
    return Math<double>::sign(x.value, rest.value);
  }
};

}  // namespace bentaxis::analytic::closed_form

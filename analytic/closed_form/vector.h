// Vectors and functions of the closed form, for one number (Real = double, long double) or for
// several in SIMD lanes. Everything of the closed form is inlined, because a function shared by
// translation units of different instruction sets would be linked in the version of any of them.
#pragma once

#include <cmath>

#define BENTAXIS_INLINE [[gnu::always_inline]] inline

namespace bentaxis::analytic::closed_form {

template <class T>
struct Vec3 {
  T x, y, z;
};
template <class T>
BENTAXIS_INLINE Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
BENTAXIS_INLINE Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T, class S>
BENTAXIS_INLINE Vec3<T> operator*(const S& s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
BENTAXIS_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The functions beyond arithmetic that the algebra needs. Vectors of lanes specialise it.
template <class Real>
struct Math {
  BENTAXIS_INLINE static Real root(Real x) { return std::sqrt(x); }
  BENTAXIS_INLINE static Real magnitude(Real x) { return std::abs(x); }
  BENTAXIS_INLINE static Real tangent(Real x) { return std::tanh(x); }
  /// 1 or -1; 1 for 0.
  BENTAXIS_INLINE static Real direction(Real x) { return x < 0 ? Real(-1) : Real(1); }
  /// The sign of x, 0 where |x| <= rest.
  BENTAXIS_INLINE static Real sign(Real x, Real rest) {
    return magnitude(x) <= rest ? Real(0) : direction(x);
  }
};

}  // namespace bentaxis::analytic::closed_form

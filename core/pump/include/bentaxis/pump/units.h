// Conversions at the border. Inside the program everything is SI: m, kg, s, N, Nm, Pa, rad.
#pragma once

#include <cmath>

namespace bentaxis {

inline constexpr double kPi = 3.14159265358979323846264338327950288;
inline constexpr double kRadPerDegree = kPi / 180.0;
inline constexpr double kRadPerSecondPerRpm = kPi / 30.0;
inline constexpr double kPascalPerBar = 1e5;
inline constexpr double kLitrePerMinute = 1e-3 / 60;  // m3/s

// Division by a power of ten is correctly rounded; multiplication by 1e-3 is not.
inline double metres(double millimetres) { return millimetres / 1e3; }
inline double square_metres(double square_millimetres) { return square_millimetres / 1e6; }
inline double pascals(double bar) { return bar * kPascalPerBar; }
inline double radians(double degrees) { return degrees * kRadPerDegree; }
inline double rad_per_second(double rpm) { return rpm * kRadPerSecondPerRpm; }

/// The same direction in [0, 360) degrees.
inline double wrap_degrees(double angle) {
  double wrapped = std::fmod(angle, 360.0);
  if (wrapped < 0) wrapped += 360.0;
  return wrapped >= 360.0 ? 0.0 : wrapped;
}

}  // namespace bentaxis

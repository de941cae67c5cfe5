// A speed or torque over time, from the points of a file.
#pragma once

#include <vector>

#include "bentaxis/pump/drive_spec.h"

namespace bentaxis {

/// Piecewise cubic through its points, monotone between them (F. N. Fritsch, J. Butland, SIAM J.
/// Sci. Stat. Comput. 5 (1984) 300-304), constant before the first and after the last.
class TimeSignal {
 public:
  /// @throws InputError with fewer than 4 points, or times that do not rise
  explicit TimeSignal(const TimeCurve& curve);

  double value(double time) const;
  double slope(double time) const;
  /// From 0 to `time`.
  double integral(double time) const;
  /// s, where higher derivatives jump.
  const std::vector<double>& breakpoints() const { return time_; }
  [[deprecated("use breakpoints")]] const std::vector<double>& knots() const { return time_; }

 private:
  std::size_t piece(double time) const;
  double from_first(double time) const;

  std::vector<double> time_, value_, slope_;
  std::vector<double> area_;  // from the first point to each
  double offset_ = 0;         // from the first point to 0
};

}  // namespace bentaxis

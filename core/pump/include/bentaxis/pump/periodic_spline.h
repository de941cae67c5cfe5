// A smooth curve over the turn through given points.
#pragma once

#include <cstddef>
#include <vector>

namespace bentaxis {

/// Periodic cubic spline (twice continuously differentiable) of period 360 degrees.
class PeriodicSpline {
 public:
  /// @param angle_deg  at least 3, strictly increasing, last - first < 360 (the end point is not
  ///                   repeated)
  /// @param value      one per angle
  /// @throws InputError where the angles are not as required.
  PeriodicSpline(const std::vector<double>& angle_deg, const std::vector<double>& value);

  /// Value at any angle, degrees.
  double operator()(double angle_deg) const;
  /// Its derivative there, per degree.
  double slope(double angle_deg) const;

  struct Extremes {
    double least = 0, greatest = 0;
  };
  /// Of the curve, between the points too.
  Extremes extremes() const;

 private:
  std::size_t piece_at(double at) const;  // x_.front() <= at < x_.back()
  double slope_in(std::size_t piece, double at) const;

  std::vector<double> x_, y_, curvature_;  // the first point comes again at the end, a turn later
};

}  // namespace bentaxis

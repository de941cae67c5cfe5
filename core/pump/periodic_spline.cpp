#include "bentaxis/pump/periodic_spline.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {

// By the second derivatives at the points: a cyclic tridiagonal system.
PeriodicSpline::PeriodicSpline(const std::vector<double>& angle_deg,
                               const std::vector<double>& value)
    : x_(angle_deg), y_(value) {
  if (x_.size() < 3)
    throw InputError("at least 3 points needed, found " + std::to_string(x_.size()));
  for (std::size_t i = 1; i < x_.size(); ++i)
    if (!(x_[i] > x_[i - 1])) throw InputError("angles must increase strictly");
  if (!(x_.back() - x_.front() < 360))
    throw InputError(
        "last angle minus first must be below 360 deg (the end point is not repeated)");
  const auto n = static_cast<int>(x_.size());
  x_.push_back(x_.front() + 360.0);
  y_.push_back(y_.front());
  Eigen::SparseMatrix<double> system(n, n);
  Eigen::VectorXd right(n);
  std::vector<Eigen::Triplet<double>> entries;
  const auto step = [&](int i) { return x_[i + 1] - x_[i]; };
  const auto slope = [&](int i) { return (y_[i + 1] - y_[i]) / step(i); };
  for (int i = 0; i < n; ++i) {
    const int before = (i + n - 1) % n;
    entries.emplace_back(i, before, step(before));
    entries.emplace_back(i, i, 2 * (step(before) + step(i)));
    entries.emplace_back(i, (i + 1) % n, step(i));
    right[i] = 6 * (slope(i) - slope(before));
  }
  system.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(system);
  const Eigen::VectorXd solution = solver.solve(right);
  curvature_.assign(solution.begin(), solution.end());
  curvature_.push_back(curvature_.front());
}

std::size_t PeriodicSpline::piece_at(double at) const {
  const auto upper = std::upper_bound(x_.begin() + 1, x_.end() - 1, at);
  return static_cast<std::size_t>(upper - x_.begin()) - 1;
}

double PeriodicSpline::operator()(double angle_deg) const {
  const double at = x_.front() + wrap_degrees(angle_deg - x_.front());
  const std::size_t i = piece_at(at);
  const double h = x_[i + 1] - x_[i];
  const double a = (x_[i + 1] - at) / h;
  const double b = (at - x_[i]) / h;
  return a * y_[i] + b * y_[i + 1] +
         (a * (a * a - 1) * curvature_[i] + b * (b * b - 1) * curvature_[i + 1]) * h * h / 6;
}

double PeriodicSpline::slope_in(std::size_t piece, double at) const {
  const std::size_t next = piece + 1;
  const double h = x_[next] - x_[piece];
  const double a = (x_[next] - at) / h;
  const double b = (at - x_[piece]) / h;
  return (y_[next] - y_[piece]) / h +
         ((3 * b * b - 1) * curvature_[next] - (3 * a * a - 1) * curvature_[piece]) * h / 6;
}

double PeriodicSpline::slope(double angle_deg) const {
  const double at = x_.front() + wrap_degrees(angle_deg - x_.front());
  return slope_in(piece_at(at), at);
}

PeriodicSpline::Extremes PeriodicSpline::extremes() const {
  Extremes found{y_.front(), y_.front()};
  const auto meet = [&](double value) {
    found.least = std::min(found.least, value);
    found.greatest = std::max(found.greatest, value);
  };
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    meet(y_[i]);
    // The slope is quadratic in t = at - x_i: first + curvature t + bend t^2.
    const double h = x_[i + 1] - x_[i];
    const double first = slope_in(i, x_[i]);
    const double bend = (curvature_[i + 1] - curvature_[i]) / (2 * h);
    const double discriminant = curvature_[i] * curvature_[i] - 4 * bend * first;
    if (!(discriminant >= 0)) continue;
    // Both roots without a difference of nearly equal numbers.
    const double q = -(curvature_[i] + std::copysign(std::sqrt(discriminant), curvature_[i])) / 2;
    for (const double t : {q / bend, first / q})
      if (t > 0 && t < h) meet((*this)(x_[i] + t));
  }
  return found;
}

}  // namespace bentaxis

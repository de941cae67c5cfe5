#include "bentaxis/pump/pressure.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include "bentaxis/pump/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

// An angle this close to an edge counts as on it, degrees.
constexpr double kEdgeTolerance = 1e-9;

double wrap_degrees(double angle) {
  double wrapped = std::fmod(angle, 360.0);
  if (wrapped < 0) wrapped += 360.0;
  return wrapped >= 360.0 ? 0.0 : wrapped;
}

double smooth_step(double t) { return t * t * (3 - 2 * t); }

}  // namespace

// Periodic cubic spline by its second derivatives at the points (cyclic tridiagonal system).
struct PressureTrace::Spline {
  std::vector<double> x, y, curvature;  // x has one more entry: the first point a turn later

  explicit Spline(const PressureCurve& curve) : x(curve.theta_deg), y(curve.pressure) {
    const auto n = static_cast<int>(x.size());
    x.push_back(x.front() + 360.0);
    y.push_back(y.front());
    Eigen::SparseMatrix<double> system(n, n);
    Eigen::VectorXd right(n);
    std::vector<Eigen::Triplet<double>> entries;
    const auto step = [&](int i) { return x[i + 1] - x[i]; };
    const auto slope = [&](int i) { return (y[i + 1] - y[i]) / step(i); };
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
    curvature.assign(solution.begin(), solution.end());
    curvature.push_back(curvature.front());
  }

  double operator()(double angle) const {
    const double at = x.front() + wrap_degrees(angle - x.front());
    const auto upper = std::upper_bound(x.begin() + 1, x.end() - 1, at);
    const auto i = static_cast<std::size_t>(upper - x.begin()) - 1;
    const double h = x[i + 1] - x[i];
    const double a = (x[i + 1] - at) / h;
    const double b = (at - x[i]) / h;
    return a * y[i] + b * y[i + 1] +
           (a * (a * a - 1) * curvature[i] + b * (b * b - 1) * curvature[i + 1]) * h * h / 6;
  }
};

PressureTrace::PressureTrace(const PressureSpec& spec)
    : kind_(spec.kind),
      ports_(spec.ports),
      transition_deg_(spec.transition_deg),
      delivery_start_deg_(spec.delivery_start_deg) {
  if (kind_ != PressureKind::ideal) {
    const auto& theta = spec.curve.theta_deg;
    const auto fail = [&](const std::string& why) {
      throw InputError(spec.file.string() + ": pressure curve: " + why);
    };
    if (kind_ == PressureKind::hydraulic && theta.empty())
      throw InputError(
          "[pressure] kind = \"hydraulic\": this job needs the pressure to be computed first");
    if (theta.size() < 3) fail("at least 3 points needed, found " + std::to_string(theta.size()));
    for (std::size_t i = 1; i < theta.size(); ++i)
      if (!(theta[i] > theta[i - 1])) fail("angles must increase strictly");
    if (!(theta.back() - theta.front() < 360))
      fail("last angle minus first must be below 360 deg (the end point is not repeated)");
    spline_ = std::make_unique<Spline>(spec.curve);
    return;
  }
  const double half = transition_deg_ / 2;
  if (half > 0) {
    for (const double edge : {-half, half, 180 - half, 180 + half})
      edges_deg_.push_back(wrap_degrees(delivery_start_deg_ + edge));
  } else {
    edges_deg_ = {wrap_degrees(delivery_start_deg_), wrap_degrees(delivery_start_deg_ + 180)};
  }
  std::sort(edges_deg_.begin(), edges_deg_.end());
  edges_deg_.erase(std::unique(edges_deg_.begin(), edges_deg_.end()), edges_deg_.end());
}

PressureTrace::~PressureTrace() = default;
PressureTrace::PressureTrace(PressureTrace&&) noexcept = default;
PressureTrace& PressureTrace::operator=(PressureTrace&&) noexcept = default;

double PressureTrace::operator()(double theta_k_deg) const {
  return spline_ ? (*spline_)(theta_k_deg) : ideal(theta_k_deg);
}

double PressureTrace::ideal(double theta_k_deg) const {
  double past = wrap_degrees(theta_k_deg - delivery_start_deg_);
  for (const double edge : {0.0, 180.0, 360.0})
    if (std::abs(past - edge) <= kEdgeTolerance) past = edge;
  if (past == 360.0) past = 0;

  const double width = transition_deg_;
  const double half = width / 2;
  double share = 0;  // of the way from suction to delivery
  if (width == 0) {
    share = past < 180 ? 1 : 0;
  } else if (past <= half) {
    share = smooth_step((past + half) / width);
  } else if (past < 180 - half) {
    share = 1;
  } else if (past <= 180 + half) {
    share = 1 - smooth_step((past - 180 + half) / width);
  } else if (past >= 360 - half) {
    share = smooth_step((past - 360 + half) / width);
  }
  return ports_.suction + (ports_.delivery - ports_.suction) * share;
}

PressureCurve read_pressure_curve(const std::filesystem::path& file) {
  const NumericTable table = read_numeric_csv(file);
  const std::vector<std::string> wanted = {"theta_deg", "pressure_bar"};
  if (table.header != wanted)
    throw InputError(file.string() + ":1: header must be theta_deg,pressure_bar");
  PressureCurve curve;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double theta = table.rows[i][0];
    const auto refuse = [&](const std::string& range) {
      throw InputError(file.string() + ":" + std::to_string(table.lines[i]) +
                       ": theta_deg = " + number_text(theta) + ": must be " + range);
    };
    if (i > 0 && !(theta > curve.theta_deg.back()))
      refuse("> " + number_text(curve.theta_deg.back()) + " (angles increase strictly)");
    if (i > 0 && !(theta - curve.theta_deg.front() < 360))
      refuse("< " + number_text(curve.theta_deg.front() + 360) +
             " (a turn after the first; the end point is not repeated)");
    curve.theta_deg.push_back(theta);
    curve.pressure.push_back(pascals(table.rows[i][1]));
  }
  return curve;
}

}  // namespace bentaxis

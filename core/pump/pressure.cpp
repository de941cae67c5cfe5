#include "bentaxis/pump/pressure.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

// An angle this close to an edge counts as on it, degrees.
constexpr double kEdgeTolerance = 1e-9;

double smooth_step(double t) { return t * t * (3 - 2 * t); }

}  // namespace

double ComputedPressure::gauge(double theta_k_deg) const {
  return atmosphere * std::expm1(log_pressure(theta_k_deg));
}

PressureTrace::PressureTrace(const PressureSpec& spec)
    : kind_(spec.kind),
      ports_(spec.ports),
      transition_deg_(spec.transition_deg),
      delivery_start_deg_(spec.delivery_start_deg) {
  if (kind_ == PressureKind::hydraulic) {
    if (!spec.computed)
      throw InputError("[pressure] kind = \"hydraulic\": the pressure must be computed first");
    if (spec.points == 0) {
      computed_ = spec.computed;
      edges_deg_ = computed_->edges_deg;
      return;
    }
  }
  if (kind_ != PressureKind::ideal) {
    try {
      spline_ = std::make_unique<PeriodicSpline>(spec.curve.theta_deg, spec.curve.pressure);
    } catch (const InputError& error) {
      throw InputError(spec.file.string() + ": pressure curve: " + error.what());
    }
    return;
  }
  const double half = transition_deg_ / 2;
  for (const double edge : {-half, half, 180 - half, 180 + half})
    edges_deg_.push_back(wrap_degrees(delivery_start_deg_ + edge));
  std::sort(edges_deg_.begin(), edges_deg_.end());
  edges_deg_.erase(std::unique(edges_deg_.begin(), edges_deg_.end()), edges_deg_.end());
}

double PressureTrace::operator()(double theta_k_deg) const {
  if (spline_) return (*spline_)(theta_k_deg);
  if (computed_) return computed_->gauge(theta_k_deg);
  return ports_.suction + (ports_.delivery - ports_.suction) * share_of_delivery(theta_k_deg);
}

std::optional<double> PressureTrace::ideal_share(double theta_k_deg) const {
  if (kind_ != PressureKind::ideal) return std::nullopt;
  return share_of_delivery(theta_k_deg);
}

double PressureTrace::share_of_delivery(double theta_k_deg) const {
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
  return share;
}

std::vector<double> block_edges_deg(const PressureTrace& pressure, int pistons) {
  std::vector<double> edges;
  for (const double edge : pressure.edges_deg())
    for (int k = 0; k < pistons; ++k) edges.push_back(wrap_degrees(edge + 360.0 * k / pistons));
  std::sort(edges.begin(), edges.end());
  constexpr double kSame = 1e-9;
  edges.erase(
      std::unique(edges.begin(), edges.end(), [](double a, double b) { return b - a < kSame; }),
      edges.end());
  if (edges.size() > 1 && edges.front() + 360 - edges.back() < kSame) edges.pop_back();
  return edges;
}

}  // namespace bentaxis

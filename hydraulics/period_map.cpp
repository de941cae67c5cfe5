#include "period_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bentaxis/numerics/dense.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::hydraulics {
namespace {

// Largest change of ln P and of ln(load area) in one Newton step.
constexpr double kLongestStep = 2;
constexpr int kMaxIterations = 40;
constexpr int kMaxHalvings = 12;

}  // namespace

double PeriodMap::load_size(const Vector& z) const {
  if (sized_) return std::exp(z[network_.states()]);
  return sizing_ == Sizing::closed ? network_.load().closed() : network_.load().size();
}

std::vector<double> PeriodMap::states(const Vector& z) const {
  return {z.data(), z.data() + network_.states()};
}

std::vector<double> PeriodMap::relabelled(const std::vector<double>& end) const {
  std::vector<double> next;
  for (const int from : network_.order_after_period()) next.push_back(end[from]);
  return next;
}

PeriodMap::Vector PeriodMap::residual(const Vector& z, double tolerance, Matrix* jacobian,
                                      Integrals* integrals, const Integrator::Watch& watch) {
  std::vector<double> sensitivity;
  const auto end =
      integrator_.over_period(states(z), load_size(z), tolerance,
                              jacobian != nullptr ? &sensitivity : nullptr, integrals, watch);
  const int size = network_.size();
  Vector result(unknowns());
  const auto next = relabelled(end);
  for (int i = 0; i < network_.states(); ++i) result[i] = next[i] - z[i];
  if (sized_) result[unknowns() - 1] = end[size - 1] - 1;
  mean_ =
      network_.fixed_line() ? network_.delivery_pressure() : end[size - 1] * network_.mean_scale();
  if (jacobian != nullptr) {
    const Eigen::Map<const Matrix> end_by_start(sensitivity.data(), size, unknowns());
    jacobian->resize(unknowns(), unknowns());
    const std::vector<int> order = network_.order_after_period();
    for (int i = 0; i < network_.states(); ++i) jacobian->row(i) = end_by_start.row(order[i]);
    if (sized_) jacobian->row(unknowns() - 1) = end_by_start.row(size - 1);
    for (int i = 0; i < network_.states(); ++i) (*jacobian)(i, i) -= 1;
  }
  return result;
}

double size_of(const PeriodMap::Vector& v) { return v.lpNorm<Eigen::Infinity>(); }

void search(PeriodMap& map, PeriodMap::Vector& z, double tolerance, PeriodMap::Matrix& jacobian,
            int& iterations, const std::function<void()>& alive) {
  PeriodMap::Vector f = map.residual(z, tolerance, &jacobian);
  double best = size_of(f);
  for (; best > map.noise() * tolerance; ++iterations) {
    if (alive) alive();
    if (iterations >= kMaxIterations)
      throw ComputationError("hydraulics: no periodic state found after " +
                             std::to_string(iterations) +
                             " Newton steps; pressures still change by a factor of up to exp(" +
                             number_text(best) + ") per period");
    PeriodMap::Vector step = -numerics::LinearSolver(jacobian).solve(f);
    if (!step.allFinite())
      throw ComputationError(
          "hydraulics: no periodic state found: no load results in this mean delivery pressure");
    step *= std::min(1.0, kLongestStep / size_of(step));
    bool accepted = false;
    for (int halving = 0; halving < kMaxHalvings && !accepted; ++halving, step /= 2) {
      try {
        const PeriodMap::Vector trial = z + step;
        PeriodMap::Matrix trial_jacobian;
        const PeriodMap::Vector trial_f = map.residual(trial, tolerance, &trial_jacobian);
        // A longer residual is allowed at first: the orifice roots make the map far from linear.
        if (size_of(trial_f) < (1 - 1e-4) * best) {
          z = trial;
          f = trial_f;
          jacobian = trial_jacobian;
          best = size_of(f);
          accepted = true;
        }
      } catch (const IntegrationFailure&) {
        // Too far: the integration does not get through the period from there.
      }
    }
    if (!accepted) return;  // at the noise of the integration, or stuck: the caller looks at it
  }
}

}  // namespace bentaxis::hydraulics

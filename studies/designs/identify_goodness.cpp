// Whether the data refute a fit, what they refute it by, and what would improve it.
#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <set>

#include "bentaxis/designs/identify.h"
#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/reporting.h"
#include "row_major.h"

namespace bentaxis::designs {
namespace {

using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

// A direction of the unknowns in which the data are weaker than this share of what bounds say is
// not fitted: the search keeps it at the case's values.
constexpr double kWeakest = 1e-3;
// Of an unknown's bounds: this near it is held by one.
constexpr double kAtBound = 1e-6;
// Share of a parameter's derivative that the unknowns do not reproduce: less is one of them.
constexpr double kOwnShare = 1e-4;
// How many parameters are fitted after the comparison by derivatives.
constexpr std::size_t kRefits = 8;
// A fitted further unknown stays within this many times its linear estimate.
constexpr double kReach = 10;

// One place of a residual: which datum or prior it is of.
struct Place {
  std::optional<std::size_t> datum, unknown;
  std::size_t number = 0;
};

// Of the residuals of DataModel::problem(), in their order.
std::vector<Place> places_of(const DataModel& model) {
  std::vector<Place> places;
  const auto& data = model.data().data;
  for (std::size_t i = 0; i < data.size(); ++i)
    for (std::size_t k = 0; data[i].use == Use::fitted && k < data[i].size(); ++k)
      places.push_back({i, std::nullopt, k});
  for (std::size_t i = 0; i < model.size(); ++i)
    if (model.data().unknowns[i].prior) places.push_back({std::nullopt, i, 0});
  return places;
}

bool is_window(const Datum& datum) { return !datum.curve && !datum.value; }

// Half the derivative of chi-square with respect to an unknown.
double slope_along(const DataModel& model, const LeastSquaresFit& fit, std::size_t unknown) {
  double slope = 0;
  for (std::size_t r = 0; r < fit.residuals.size(); ++r)
    slope += fit.jacobian[r * model.size() + unknown] * fit.residuals[r];
  return slope;
}

// Whether a bound holds an unknown back from where its residuals would take it.
bool is_held(const DataModel& model, const LeastSquaresFit& fit, std::size_t unknown) {
  const Unknown& u = model.data().unknowns[unknown];
  const double near = kAtBound * (u.high - u.low);
  const double slope = slope_along(model, fit, unknown);
  return (fit.x[unknown] <= u.low + near && slope >= 0) ||
         (fit.x[unknown] >= u.high - near && slope <= 0);
}

// Derivatives with respect to the unknowns that no bound holds, over the bounds' standard
// deviation.
Matrix free_derivatives(const DataModel& model, const LeastSquaresFit& fit) {
  const std::size_t n = model.size();
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < n; ++i)
    if (!is_held(model, fit, i)) free.push_back(i);
  Matrix a(static_cast<Index>(fit.residuals.size()), static_cast<Index>(free.size()));
  for (std::size_t r = 0; r < fit.residuals.size(); ++r)
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Unknown& u = model.data().unknowns[free[k]];
      a(static_cast<Index>(r), static_cast<Index>(k)) =
          fit.jacobian[r * n + free[k]] * (u.high - u.low) / std::sqrt(12.0);
    }
  return a;
}

// The residuals as a function of one further parameter alone.
LeastSquaresProblem along(const LeastSquaresProblem& whole, const std::vector<double>& x) {
  LeastSquaresProblem problem;
  problem.parameters = 1;
  problem.residuals = whole.residuals;
  problem.low = {whole.low.back()};
  problem.high = {whole.high.back()};
  problem.evaluate = [&whole, x](std::span<const double> value, std::span<double> residuals) {
    std::vector<double> all = x;
    all.push_back(value[0]);
    return whole.evaluate(all, residuals);
  };
  return problem;
}

// The same model, where an assumption turns piston friction off with a friction of 0 instead: so
// that its parameters act.
DataModel with_piston_friction(const DataModel& model) {
  Case base = model.base();
  const bool fitted = std::any_of(
      model.data().unknowns.begin(), model.data().unknowns.end(),
      [](const Unknown& u) { return u.variable.name().starts_with("friction.piston_"); });
  if (!base.analytic.piston_friction && !fitted) {
    base.analytic.piston_friction = true;
    base.pump.friction.piston_coulomb = base.pump.friction.piston_viscous = 0;
  }
  return {std::move(base), model.data()};
}

// A parameter that could be unknown too, and what its derivative promises.
struct Promise {
  Variable variable;
  double before = 0, change = 0;  ///< in the file's unit
  double gain = 0;                ///< by which chi-square would fall if the model were linear
};

DataModel with_further(const DataModel& model, const Variable& variable, double low, double high) {
  IdentificationData data = model.data();
  data.unknowns.push_back({variable, low, high});
  return {model.base(), std::move(data)};
}

// Orthonormal columns that span what the unknowns can do to the residuals; none where bounds hold
// all of them.
Matrix reproduced_by(const Matrix& derivatives) {
  if (derivatives.cols() == 0) return derivatives;
  return numerics::LeastSquaresSolver(derivatives).span();
}

// What of a derivative the unknowns cannot reproduce; nothing where that is next to nothing.
std::optional<Eigen::VectorXd> own_part(const Eigen::VectorXd& slope, const Matrix& reproduced) {
  const double length = slope.squaredNorm();
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  Eigen::VectorXd own = slope - reproduced * (reproduced.transpose() * slope);
  if (own.squaredNorm() < kOwnShare * kOwnShare * length) return std::nullopt;
  return own;
}

// By which chi-square would fall along it if the model were linear.
double gain_along(const Eigen::VectorXd& own, const Eigen::VectorXd& residuals) {
  const double slope = own.dot(residuals);
  return slope * slope / own.squaredNorm();
}

std::optional<Promise> promise_of(const DataModel& model, const LeastSquaresFit& fit,
                                  const Matrix& reproduced, const Variable& variable) {
  const NumberRange range = variable.range(model.base());
  const double before = variable.value(model.base());
  const DataModel larger = with_further(model, variable, range.low, range.high);
  const LeastSquaresProblem whole = larger.problem();
  const LeastSquaresProblem problem = along(whole, fit.x);
  Eigen::VectorXd slope(static_cast<Index>(problem.residuals));
  if (!derivatives_of(problem, std::vector{before},
                      {slope.data(), static_cast<std::size_t>(slope.size())}))
    return std::nullopt;
  const std::optional<Eigen::VectorXd> own = own_part(slope, reproduced);
  if (!own) return std::nullopt;
  const Eigen::Map<const Eigen::VectorXd> residuals(fit.residuals.data(), slope.size());
  const double change = -own->dot(residuals) / own->squaredNorm();
  // Away from a bound only.
  if ((change < 0 && before <= range.low) || (change > 0 && before >= range.high))
    return std::nullopt;
  return Promise{variable, before, change, gain_along(*own, residuals)};
}

// Names of the plausibility warnings of a pump.
std::set<std::string> warnings_of(const Case& pump) {
  std::set<std::string> names;
  for (const study::PlausibilityWarning& doubt : study::plausibility(pump).warnings)
    names.insert(doubt.code);
  return names;
}

std::optional<FurtherUnknown> refit(const DataModel& model, const LeastSquaresFit& fit,
                                    const Promise& promise) {
  const NumberRange range = promise.variable.range(model.base());
  const double reach = kReach * std::abs(promise.change);
  const DataModel larger =
      with_further(model, promise.variable, std::max(range.low, promise.before - reach),
                   std::min(range.high, promise.before + reach));
  const LeastSquaresOptions options{.most_iterations = 60, .enough = 1e-3};
  std::vector<double> start = fit.x;
  start.push_back(promise.before);
  const LeastSquaresFit found = least_squares(larger.problem(), start, options);
  FurtherUnknown further{promise.variable, promise.before, found.x.back(),
                         goodness_of(larger, found)};
  const std::set<std::string> without = warnings_of(model.pump(fit.x));
  for (const std::string& warning : warnings_of(larger.pump(found.x)))
    if (!without.contains(warning)) further.implausible.push_back(warning);
  return further;
}

// Runs a job that finds something or nothing for each of `count`, by threads.
template <class Found, class Job>
std::vector<Found> found_by(int threads, std::size_t count, const Job& job,
                            study::Reporting& reporting) {
  std::vector<std::optional<Found>> all(count);
  numerics::parallel_for(threads, count, [&](std::size_t i) {
    // Nothing where a condition sets it, or it makes no pump.
    study::reason_of([&] { all[i] = job(i); });
    reporting.done();
  });
  std::vector<Found> found;
  for (auto& one : all)
    if (one) found.push_back(std::move(*one));
  return found;
}

}  // namespace

std::vector<HeldUnknown> held_unknowns(const DataModel& model, const LeastSquaresFit& fit) {
  // Less is what the weak restraint to the case's values does.
  constexpr double kSmallestGain = 0.01;
  std::vector<HeldUnknown> held;
  const Matrix reproduced = reproduced_by(free_derivatives(model, fit));
  const auto count = static_cast<Index>(fit.residuals.size());
  const Eigen::Map<const Eigen::VectorXd> residuals(fit.residuals.data(), count);
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (!is_held(model, fit, i)) continue;
    Eigen::VectorXd column(count);
    for (Index r = 0; r < count; ++r)
      column[r] = fit.jacobian[static_cast<std::size_t>(r) * model.size() + i];
    // Beyond the bound the others follow: their part of it changes nothing.
    const std::optional<Eigen::VectorXd> own = own_part(column, reproduced);
    if (!own) continue;
    if (const double gain = gain_along(*own, residuals); gain > kSmallestGain)
      held.push_back({i, slope_along(model, fit, i) < 0, gain});
  }
  return held;
}

double chi_square_p_value(double chi_square, std::size_t degrees_of_freedom) {
  if (!std::isfinite(chi_square)) return 0;
  const boost::math::chi_squared law(static_cast<double>(degrees_of_freedom));
  return boost::math::cdf(complement(law, chi_square));
}

bool GoodnessOfFit::refuted() const {
  return (p_value ? *p_value : chi_square_p_value(chi_square, 1)) < kFitRefutedBelow;
}

bool GoodnessOfFit::uncertainties_too_large() const {
  return p_value && *p_value > kUncertaintiesTooLargeAbove;
}

double GoodnessOfFit::birge_ratio() const {
  return std::sqrt(chi_square /
                   static_cast<double>(std::max<std::size_t>(degrees_of_freedom(), 1)));
}

GoodnessOfFit goodness_of(const DataModel& model, const LeastSquaresFit& fit) {
  GoodnessOfFit goodness;
  Matrix a = free_derivatives(model, fit);
  const std::vector<Place> places = places_of(model);
  for (std::size_t r = 0; r < places.size(); ++r) {
    goodness.chi_square += fit.residuals[r] * fit.residuals[r];
    const bool kept =
        places[r].datum && is_window(model.data().data[*places[r].datum]) && fit.residuals[r] == 0;
    if (kept)
      a.row(static_cast<Index>(r)).setZero();
    else
      ++goodness.residuals;
  }
  if (a.cols() > 0) {
    const Eigen::VectorXd information = numerics::symmetric_eigenvalues(a.transpose() * a);
    goodness.fitted_directions = static_cast<std::size_t>((information.array() > kWeakest).count());
    goodness.fitted_directions = std::min(goodness.fitted_directions, goodness.residuals);
  }
  if (goodness.degrees_of_freedom() > 0)
    goodness.p_value = chi_square_p_value(goodness.chi_square, goodness.degrees_of_freedom());
  return goodness;
}

std::vector<FurtherUnknown> further_unknowns(const DataModel& of_fit, const LeastSquaresFit& fit,
                                             int threads, const Progress& progress) {
  const DataModel model = with_piston_friction(of_fit);
  const Matrix reproduced = reproduced_by(free_derivatives(model, fit));
  std::set<std::string> known;
  for (const Unknown& u : model.data().unknowns)
    if (u.condition.empty()) known.insert(u.variable.name());
  std::vector<Variable> variables = continuous_variables(model.base());
  std::erase_if(variables, [&](const Variable& v) { return known.contains(v.name()); });
  study::Reporting reporting(variables.size() + kRefits, progress);
  std::vector<Promise> promises = found_by<Promise>(
      threads, variables.size(),
      [&](std::size_t i) { return promise_of(model, fit, reproduced, variables[i]); }, reporting);
  std::stable_sort(promises.begin(), promises.end(),
                   [](const Promise& a, const Promise& b) { return a.gain > b.gain; });
  std::vector<FurtherUnknown> found = found_by<FurtherUnknown>(
      threads, std::min(promises.size(), kRefits),
      [&](std::size_t i) { return refit(model, fit, promises[i]); }, reporting);
  std::erase_if(found,
                [&](const FurtherUnknown& f) { return !(f.fit.chi_square < fit.sum_of_squares); });
  std::stable_sort(found.begin(), found.end(),
                   [](const FurtherUnknown& a, const FurtherUnknown& b) {
                     if (a.implausible.empty() != b.implausible.empty())
                       return a.implausible.empty();
                     return a.fit.chi_square < b.fit.chi_square;
                   });
  return found;
}

std::vector<WorstResidual> worst_residuals(const DataModel& model, const LeastSquaresFit& fit) {
  std::vector<WorstResidual> all;
  const std::vector<Place> places = places_of(model);
  for (std::size_t r = 0; r < places.size(); ++r) {
    const Place& place = places[r];
    if (all.empty() || all.back().datum != place.datum || all.back().unknown != place.unknown)
      all.push_back({place.datum, place.unknown, place.number, fit.residuals[r], 0});
    WorstResidual& one = all.back();
    one.share += fit.residuals[r] * fit.residuals[r];
    if (std::abs(fit.residuals[r]) > std::abs(one.residual)) {
      one.residual = fit.residuals[r];
      one.number = place.number;
    }
  }
  for (WorstResidual& one : all)
    one.share = fit.sum_of_squares > 0 ? one.share / fit.sum_of_squares : 0;
  std::stable_sort(all.begin(), all.end(), [](const WorstResidual& a, const WorstResidual& b) {
    return std::abs(a.residual) > std::abs(b.residual);
  });
  return all;
}

}  // namespace bentaxis::designs

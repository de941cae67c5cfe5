#include "bentaxis/designs/search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/designs/points.h"
#include "bentaxis/files/module.h"
#include "bentaxis/pump/error.h"

#ifdef BENTAXIS_HAS_SEARCH
#include <nlopt.h>

#include <exception>
#include <memory>
#include <nlopt.hpp>
#include <pagmo/config.hpp>  // its version: the library is linked with search_module.cpp

#include "search_module.h"
#endif

namespace bentaxis::designs {

double violation(const SearchProblem& problem, std::span<const double> results) {
  double sum = 0;
  for (std::size_t k = 0; k < problem.numbers(); ++k) {
    if (!std::isfinite(results[k])) return std::numeric_limits<double>::infinity();
    if (k >= problem.objectives) sum += std::max(0.0, results[k]);
  }
  return sum;
}

namespace {

// A point by its shares of the ranges, in (0, 1).
void append_point(const SearchProblem& problem, std::span<const double> shares,
                  std::vector<double>& points) {
  for (std::size_t k = 0; k < problem.variables(); ++k) {
    const double width = problem.high[k] - problem.low[k];
    points.push_back(problem.whole[k] ? problem.low[k] + std::floor(shares[k] * (width + 1))
                                      : problem.low[k] + shares[k] * width);
  }
}

}  // namespace

std::vector<double> random_search_points(const SearchProblem& problem, std::size_t count,
                                         std::uint64_t seed) {
  const auto drawn = random(problem.variables(), count, seed);
  std::vector<double> points, shares(problem.variables());
  for (std::size_t i = 0; i < count; ++i) {
    drawn->point(i, shares);
    append_point(problem, shares, points);
  }
  return points;
}

std::vector<double> grid_search_points(const SearchProblem& problem, std::size_t count) {
  const std::size_t n = problem.variables();
  std::vector<std::size_t> values(n, 1);
  std::size_t all = 1;
  // One value more for the variable that has fewest, as long as that leaves no more than `count`.
  for (;;) {
    std::size_t next = n;
    for (std::size_t k = 0; k < n; ++k) {
      const bool more = !problem.whole[k] ||
                        static_cast<double>(values[k]) < problem.high[k] - problem.low[k] + 1;
      if (more && (next == n || values[k] < values[next])) next = k;
    }
    if (next == n || all / values[next] * (values[next] + 1) > count) break;
    all = all / values[next] * (values[next] + 1);
    ++values[next];
  }
  std::vector<std::vector<double>> axes;
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> axis;
    for (std::size_t i = 0; i < values[k]; ++i) {
      const double share =
          values[k] == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(values[k] - 1);
      const double value = problem.low[k] + share * (problem.high[k] - problem.low[k]);
      axis.push_back(problem.whole[k] ? std::round(value) : value);
    }
    axes.push_back(std::move(axis));
  }
  const auto crossed = grid(std::move(axes));
  std::vector<double> points(crossed->size() * n);
  for (std::size_t i = 0; i < crossed->size(); ++i)
    crossed->point(i, std::span(points).subspan(i * n, n));
  return points;
}

#ifdef BENTAXIS_HAS_SEARCH

namespace {

// Worse than any allowed point, and the worse the more is violated.
constexpr double kForbidden = 1e30;
constexpr double kNoValues = 1e60;
// Of a refinement.
constexpr int kMaxSteps = 100;
constexpr std::size_t kMinEvaluations = 30;
constexpr double kStepTolerance = 1e-8;        // of the range of a variable
constexpr double kConstraintTolerance = 1e-9;  // of its scale
// Kept from every constraint, of its scale: what ends on one is allowed for all that.
constexpr double kMargin = 1e-8;
// Of one objective: descents from the best point and from others of the first populations that are
// at least so far apart, in shares of the ranges.
constexpr std::size_t kDescents = 4;
constexpr double kApart = 0.2;

void must_be_possible(const SearchProblem& problem, const SearchOptions& options) {
  if (options.population < 8 || options.population % 4 != 0)
    throw InputError("--population " + std::to_string(options.population) +
                     ": must be a multiple of 4, at least 8");
  if (options.restarts < 1) throw InputError("--restarts: must be at least 1");
  for (std::size_t k = 0; k < problem.variables(); ++k)
    if (!(problem.low[k] < problem.high[k]))
      throw InputError("search: a variable needs a lower bound below its upper one");
}

const Module& module() {
  static const Module loaded(BENTAXIS_SEARCH_MODULE);
  return loaded;
}

template <class Function>
Function& of_pagmo(const char* name) {
  return module().function<Function>(name, "optimise");
}

// Costs of points whose variables are in another order; what is not allowed costs more than all
// that is.
std::vector<double> costs_without_constraints(const SearchProblem& problem,
                                              const std::vector<std::size_t>& order,
                                              const std::vector<double>& xs) {
  const std::size_t n = problem.variables(), m = problem.numbers();
  const std::size_t count = xs.size() / n;
  std::vector<double> points(xs.size()), results(count * m);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < n; ++k) points[i * n + order[k]] = xs[i * n + k];
  problem.evaluate(count, points, results);
  std::vector<double> costs;
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = std::span<const double>(results).subspan(i * m, m);
    const double wrong = violation(problem, row);
    for (std::size_t k = 0; k < problem.objectives; ++k)
      costs.push_back(wrong == 0          ? row[k]
                      : std::isinf(wrong) ? kNoValues
                                          : kForbidden * (1 + wrong));
  }
  return costs;
}

// The first population: the points to start from, then such as fill the whole range evenly.
std::vector<double> first_points(const SearchProblem& problem, std::span<const double> start,
                                 std::size_t count, std::uint64_t seed) {
  const std::size_t n = problem.variables();
  std::vector<double> points(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(
                                                                std::min(start.size(), count * n)));
  const auto even = sobol(n, count, seed);
  std::vector<double> share(n);
  for (std::size_t i = 0; points.size() < count * n; ++i) {
    even->point(i, share);
    append_point(problem, share, points);
  }
  return points;
}

void explore(const SearchProblem& problem, std::span<const double> start,
             const SearchOptions& options, std::uint64_t seed) {
  const std::size_t n = problem.variables(), size = options.population;
  std::vector<std::size_t> order;  // pagmo's variable k is this one
  for (const bool whole : {false, true})
    for (std::size_t k = 0; k < n; ++k)
      if (problem.whole[k] == whole) order.push_back(k);
  Evolution evolution;
  for (const std::size_t k : order) {
    evolution.low.push_back(problem.low[k]);
    evolution.high.push_back(problem.high[k]);
    evolution.whole += problem.whole[k] ? 1 : 0;
  }
  evolution.objectives = problem.objectives;
  const std::vector<double> points = first_points(problem, start, size, seed);
  for (std::size_t i = 0; i < size; ++i)
    for (const std::size_t k : order) evolution.first.push_back(points[i * n + k]);
  evolution.generations = static_cast<unsigned>(options.generations);
  evolution.seed = static_cast<unsigned>(seed);
  evolution.costs = [&](const std::vector<double>& xs) {
    return costs_without_constraints(problem, order, xs);
  };
  of_pagmo<decltype(bentaxis_evolve)>("bentaxis_evolve")(evolution);
}

// One objective by gradients, in the variables that are no whole numbers.
class Descent {
 public:
  Descent(const SearchProblem& problem, std::size_t objective, std::vector<double> x,
          std::size_t most)
      : problem_(problem), objective_(objective), most_(most), x_(std::move(x)) {
    for (std::size_t k = 0; k < problem.variables(); ++k)
      if (!problem.whole[k]) free_.push_back(k);
  }

  Refinement run() {
    Refinement result;
    result.objective = objective_;
    result.x = x_;
    const std::vector<double> first = results_at(x_);
    best_ = violation(problem_, first) == 0 ? first[objective_]
                                            : std::numeric_limits<double>::quiet_NaN();
    result.before = best_;
    best_x_ = x_;
    if (free_.empty() || !std::isfinite(violation(problem_, first))) {
      result.after = best_;
      result.message = free_.empty() ? "only whole numbers vary" : "no values at its start";
      result.evaluations = evaluations_;
      return result;
    }
    scale_ = std::max(std::abs(first[objective_]), std::numeric_limits<double>::min());
    const std::size_t n = free_.size();
    nlopt::opt method(nlopt::LD_SLSQP, static_cast<unsigned>(n));  // in shares of the ranges
    method.set_lower_bounds(0.0);
    method.set_upper_bounds(1.0);
    method.set_min_objective(&Descent::objective, this);
    if (problem_.constraints > 0)
      method.add_inequality_mconstraint(
          &Descent::constraints, this,
          std::vector<double>(problem_.constraints, kConstraintTolerance));
    method.set_maxeval(kMaxSteps);
    method.set_xtol_abs(kStepTolerance);
    std::vector<double> share;
    for (const std::size_t k : free_)
      share.push_back(std::clamp((x_[k] - problem_.low[k]) / width(k), 0.0, 1.0));
    double least = 0;
    try {
      const nlopt::result why = method.optimize(share, least);
      result.message = why == nlopt::MAXEVAL_REACHED ? "most steps reached" : "converged";
    } catch (const nlopt::forced_stop&) {
      result.message =
          evaluations_ >= most_ ? "most evaluations reached" : "no values at a point on its way";
    } catch (const nlopt::roundoff_limited&) {
      result.message = "ended by round-off";
    } catch (const std::runtime_error&) {
      result.message = "no better point nearby";
    }
    if (thrown_) std::rethrow_exception(thrown_);
    result.after = best_;
    result.x = best_x_;
    result.exact = exact_ && problem_.differentiate;
    result.evaluations = evaluations_;
    return result;
  }

 private:
  double width(std::size_t k) const { return problem_.high[k] - problem_.low[k]; }

  std::vector<double> results_at(const std::vector<double>& x) {
    std::vector<double> results(problem_.numbers());
    problem_.evaluate(1, x, results);
    ++evaluations_;
    return results;
  }

  // Numbers and, where wanted, their derivatives by the shares; kept for the next question.
  void look(unsigned n, const double* share, bool slopes) {
    const std::vector<double> at(share, share + n);
    if (at != at_) {
      if (evaluations_ >= most_) throw nlopt::forced_stop();
      at_ = at;
      jacobian_.clear();
      for (std::size_t j = 0; j < free_.size(); ++j)
        x_[free_[j]] = problem_.low[free_[j]] + at[j] * width(free_[j]);
      results_ = results_at(x_);
      const double wrong = violation(problem_, results_);
      if (std::isinf(wrong)) throw nlopt::forced_stop();
      if (wrong == 0 && !(results_[objective_] >= best_)) {
        best_ = results_[objective_];
        best_x_ = x_;
      }
    }
    if (!slopes || !jacobian_.empty()) return;
    differentiate();
    // What does not change nearby can keep no margin: a count that is allowed at 0.
    if (margin_.empty())
      for (std::size_t i = problem_.objectives; i < problem_.numbers(); ++i)
        margin_.push_back(
            std::any_of(slope(i), slope(i + 1), [](double s) { return s != 0; }) ? kMargin : 0);
  }
  std::vector<double>::const_iterator slope(std::size_t i) const {
    return jacobian_.begin() + static_cast<std::ptrdiff_t>(i * free_.size());
  }

  void differentiate() {
    const std::size_t n = problem_.variables(), m = problem_.numbers(), f = free_.size();
    jacobian_.assign(m * f, 0);
    std::vector<double> all(m * n);
    if (problem_.differentiate && problem_.differentiate(x_, all)) {
      for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < f; ++j)
          jacobian_[i * f + j] = all[i * n + free_[j]] * width(free_[j]);
      return;
    }
    exact_ = false;
    std::vector<double> points, results(2 * f * m), low(f), high(f);
    for (std::size_t j = 0; j < f; ++j)
      for (const double side : {-1.0, 1.0}) {
        const std::size_t k = free_[j];
        std::vector<double> x = x_;
        const double share = std::clamp(at_[j] + side * problem_.step, 0.0, 1.0);
        (side < 0 ? low : high)[j] = share;
        x[k] = problem_.low[k] + share * width(k);
        points.insert(points.end(), x.begin(), x.end());
      }
    problem_.evaluate(2 * f, points, results);
    evaluations_ += 2 * f;
    for (std::size_t j = 0; j < f; ++j)
      for (std::size_t i = 0; i < m; ++i) {
        // One-sided where a neighbour has no value.
        double below = results[2 * j * m + i], above = results[(2 * j + 1) * m + i];
        double from = low[j], to = high[j];
        if (!std::isfinite(below)) {
          below = results_[i];
          from = at_[j];
        }
        if (!std::isfinite(above)) {
          above = results_[i];
          to = at_[j];
        }
        jacobian_[i * f + j] = to > from ? (above - below) / (to - from) : 0;
      }
  }

  // NLopt lets no exception but its own through: kept until it has ended.
  template <class Job>
  void guarded(const Job& job) {
    try {
      job();
    } catch (const nlopt::forced_stop&) {
      throw;
    } catch (...) {
      thrown_ = std::current_exception();
      throw nlopt::forced_stop();
    }
  }

  static double objective(unsigned n, const double* share, double* gradient, void* self) {
    Descent& it = *static_cast<Descent*>(self);
    it.guarded([&] { it.look(n, share, gradient != nullptr); });
    if (gradient != nullptr)
      for (std::size_t j = 0; j < n; ++j)
        gradient[j] = it.jacobian_[it.objective_ * n + j] / it.scale_;
    return it.results_[it.objective_] / it.scale_;
  }
  static void constraints(unsigned count, double* result, unsigned n, const double* share,
                          double* gradient, void* self) {
    Descent& it = *static_cast<Descent*>(self);
    it.guarded([&] { it.look(n, share, gradient != nullptr); });
    const std::size_t first = it.problem_.objectives;
    for (std::size_t i = 0; i < count; ++i)
      result[i] = it.results_[first + i] + (it.margin_.empty() ? 0 : it.margin_[i]);
    if (gradient != nullptr) std::copy_n(it.slope(first), count * n, gradient);
  }

  const SearchProblem& problem_;
  std::size_t objective_, most_;  // of evaluations
  std::vector<double> x_;
  std::vector<std::size_t> free_;  // variables that are no whole numbers
  std::vector<double> at_, results_, jacobian_, margin_, best_x_;
  double best_ = 0, scale_ = 1;
  bool exact_ = true;
  std::size_t evaluations_ = 0;
  std::exception_ptr thrown_;
};

// A point with its cost of one objective.
struct Found {
  double wrong = std::numeric_limits<double>::infinity(), cost = 0;
  std::vector<double> x = {};
  bool operator<(const Found& other) const {
    return wrong < other.wrong || (wrong == other.wrong && cost < other.cost);
  }
};
using Founds = std::vector<Found>;

// Points to descend from: the best, then the best of the others that are apart from those before.
std::vector<std::vector<double>> starts_of(const SearchProblem& problem, const Found& best,
                                           Founds others) {
  std::vector<std::vector<double>> starts;
  const auto apart = [&](const std::vector<double>& x) {
    return std::all_of(starts.begin(), starts.end(), [&](const std::vector<double>& y) {
      double most = 0;
      for (std::size_t k = 0; k < x.size(); ++k)
        most = std::max(most, std::abs(x[k] - y[k]) / (problem.high[k] - problem.low[k]));
      return most >= kApart;
    });
  };
  std::stable_sort(others.begin(), others.end());
  others.insert(others.begin(), best);
  for (const Found& found : others)
    if (starts.size() < kDescents && std::isfinite(found.wrong) && apart(found.x))
      starts.push_back(found.x);
  return starts;
}

}  // namespace

std::string search_libraries() {
  return "pagmo " + std::to_string(PAGMO_VERSION_MAJOR) + "." +
         std::to_string(PAGMO_VERSION_MINOR) + ", NLopt " + std::to_string(nlopt::version_major()) +
         "." + std::to_string(nlopt::version_minor()) + "." +
         std::to_string(nlopt::version_bugfix());
}

SearchResult search(const SearchProblem& problem, std::span<const double> start,
                    const SearchOptions& options) {
  must_be_possible(problem, options);
  const std::size_t n = problem.variables(), m = problem.numbers();
  // For each objective the best point so far; without allowed ones that which violates least.
  std::vector<Found> best(problem.objectives);
  std::vector<Found> first;  // those of the first populations
  bool is_first = true;
  SearchResult result;
  SearchProblem watched = problem;
  watched.evaluate = [&](std::size_t count, std::span<const double> points,
                         std::span<double> results) {
    problem.evaluate(count, points, results);
    result.evaluations.back() += count;
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = results.subspan(i * m, m);
      const double wrong = violation(problem, row);
      const auto x = points.subspan(i * n, n);
      if (is_first) first.push_back({wrong, row[0], {x.begin(), x.end()}});
      for (std::size_t k = 0; k < problem.objectives; ++k)
        if (Found found{wrong, row[k], {x.begin(), x.end()}}; found < best[k])
          best[k] = std::move(found);
    }
    is_first = false;
  };
  for (std::size_t i = 0; i < options.restarts; ++i) {
    result.evaluations.push_back(0);
    is_first = true;
    explore(watched, start, options, options.seed + i);
  }
  if (!options.refine) return result;
  result.evaluations.push_back(0);
  const bool one = problem.objectives == 1;
  std::vector<std::pair<std::size_t, std::vector<double>>> starts;
  for (std::size_t k = 0; k < problem.objectives; ++k)
    for (const std::vector<double>& x : starts_of(problem, best[k], one ? first : Founds()))
      starts.emplace_back(k, x);
  // Together they may cost half as much as the searches, but some evaluations each.
  std::size_t left = 0;
  for (const std::size_t count : result.evaluations) left += count / 2;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto& [objective, x] = starts[i];
    result.refinements.push_back(
        Descent(watched, objective, x, std::max(kMinEvaluations, left / (starts.size() - i)))
            .run());
    left -= std::min(left, result.refinements.back().evaluations);
  }
  return result;
}

double hypervolume(std::span<const double> costs, std::span<const double> reference) {
  const std::size_t width = reference.size();
  std::vector<std::vector<double>> points;
  for (std::size_t i = 0; (i + 1) * width <= costs.size(); ++i) {
    const auto row = costs.subspan(i * width, width);
    bool below = true;
    for (std::size_t k = 0; k < width; ++k) below = below && row[k] < reference[k];
    if (below) points.emplace_back(row.begin(), row.end());
  }
  if (points.empty()) return 0;
  if (width == 1) {
    double least = points.front().front();
    for (const auto& point : points) least = std::min(least, point.front());
    return reference[0] - least;
  }
  return of_pagmo<decltype(bentaxis_hypervolume)>("bentaxis_hypervolume")(
      points, {reference.begin(), reference.end()});
}

#else

std::string search_libraries() { return ""; }

SearchResult search(const SearchProblem& /*problem*/, std::span<const double> /*start*/,
                    const SearchOptions& /*options*/) {
  throw InputError(
      "optimise: this program was built without pagmo and NLopt; install libpagmo-dev and "
      "libnlopt-cxx-dev (scripts/setup full) and build again");
}

double hypervolume(std::span<const double> /*costs*/, std::span<const double> /*reference*/) {
  return 0;
}

#endif

}  // namespace bentaxis::designs

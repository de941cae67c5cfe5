#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bentaxis/designs/pareto.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/stopwatch.h"
#include "optimise_pieces.h"

namespace bentaxis::designs {
namespace {

constexpr std::size_t kFastPiece = 64;  // designs computed at a time, at most; of slow ones one
constexpr std::size_t kMaxVolume = 3;   // objectives up to which volumes of fronts are computed
// Steps of differences, as a part of a range: of the closed form, and of pressures that an
// integrator computes to a tolerance.
constexpr double kSmoothStep = 1e-5, kRoughStep = 1e-3;
// Of a design that another process computed, or an earlier run: NaN says that there are no values.
constexpr const char* kElsewhere = "has no values";

// One search, its front, and what other searches find with as many evaluations.
class SearchRun {
 public:
  SearchRun(const DesignProblem& designs, const OptimiseWork& work, const Progress& progress)
      : designs_(designs),
        plan_(designs.plan),
        progress_(progress),
        raw_(designs.rows() * designs.computed()),
        batches_(work, designs.evaluator.fast() ? kFastPiece : 1,
                 [this](auto values, auto raw, auto reasons) {
                   designs_.compute(values, raw, reasons);
                 }) {
    found_.plan = plan_;
    found_.own = designs.own;
    found_.designs.plan = plan_.designs;
    found_.designs.base = designs.base;
    for (const SearchVariable& v : designs.variables) {
      problem_.low.push_back(v.low);
      problem_.high.push_back(v.high);
      problem_.whole.push_back(v.whole);
    }
    problem_.objectives = designs.objectives.size();
    problem_.constraints = plan_.constraints.size();
    problem_.step = designs.evaluator.fast() ? kSmoothStep : kRoughStep;
    problem_.differentiate = [this](auto x, auto jacobian) {
      return designs_.differentiate(x, jacobian);
    };
    problem_.evaluate = [this](std::size_t count, auto points, auto results) {
      evaluate(count, points, results);
    };
  }

  Optimisation make(bool validates) {
    const Stopwatch watch;
    std::vector<double> start;
    for (const Varied& varied : plan_.designs.varied)
      start.push_back(varied.variable.value(designs_.base));
    found_.search = search(problem_, designs_.point_of(start), plan_.search);
    SweepResult& made = found_.designs;
    made.all_infeasible = made.infeasible.size();
    made.plan.samples = made.designs;
    if (std::all_of(found_.violations.begin(), found_.violations.end(),
                    [](double wrong) { return std::isinf(wrong); }))
      throw ComputationError("optimise: no design has values; the first: " +
                             made.infeasible.front().second);
    choose();
    compare_restarts();
    made.seconds = watch.seconds();
    if (plan_.comparison == SearchComparisonChoice::yes ||
        (plan_.comparison == SearchComparisonChoice::fast && designs_.evaluator.fast()))
      for (const bool is_grid : {false, true}) found_.comparisons.push_back(compared_with(is_grid));
    found_.kept = batches_.kept();
    found_.kept_singles = batches_.kept_singles();
    if (validates) found_.validity = validity_of_chosen(found_);
    return std::move(found_);
  }

 private:
  void tell() const {
    if (progress_)
      progress_(std::min(1.0, static_cast<double>(found_.designs.designs) /
                                  static_cast<double>(plan_.evaluations())));
  }

  SweepBlock block_at(std::size_t count, std::span<const double> points, bool batch) {
    const std::size_t n = problem_.variables();
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
      const auto one = designs_.values_at(points.subspan(i * n, n));
      values.insert(values.end(), one.begin(), one.end());
    }
    const auto tick = [this] { tell(); };
    // Of the closed form a design takes less time than its file.
    return batch ? batches_.make(std::move(values), count, raw_, tick)
                 : batches_.make_singles(std::move(values), count, raw_, !designs_.evaluator.fast(),
                                         tick);
  }
  std::span<const double> raw_of(const SweepBlock& block, std::size_t design) const {
    return std::span<const double>(block.results).subspan(design * raw_, raw_);
  }

  // Of `count` designs, which are kept.
  void evaluate(std::size_t count, std::span<const double> points, std::span<double> results) {
    SweepResult& made = found_.designs;
    const Stopwatch evaluation;
    SweepBlock block = block_at(
        count, points, count == plan_.search.population && made.designs < plan_.evaluations());
    found_.evaluation_seconds += evaluation.seconds();
    for (std::size_t i = 0; i < count; ++i) {
      const auto raw = raw_of(block, i);
      const auto row = results.subspan(i * problem_.numbers(), problem_.numbers());
      designs_.numbers_of(raw, row);
      const std::vector<double> measured = designs_.outputs_in(raw);
      found_.measured.insert(found_.measured.end(), measured.begin(), measured.end());
      found_.violations.push_back(violation(problem_, row));
      std::string reason = std::move(block.reasons[i]);
      if (reason.empty()) reason = designs_.violated(raw);
      if (reason.empty() && found_.violations.back() > 0) reason = kElsewhere;
      if (reason.empty())
        made.results.insert(made.results.end(), measured.begin(), measured.end());
      else {
        made.results.insert(made.results.end(), measured.size(), not_computed());
        made.infeasible.emplace_back(made.designs + i, std::move(reason));
      }
    }
    made.values.insert(made.values.end(), block.values.begin(), block.values.end());
    made.designs += count;
    numbers_.insert(numbers_.end(), results.begin(), results.end());
    tell();
  }

  double cost(std::size_t design, std::size_t objective) const {
    return numbers_[design * problem_.numbers() + objective];
  }

  // The best designs of the front: of each objective, and between all.
  void choose() {
    const std::vector<std::size_t> front =
        pareto_front(found_.designs.results, plan_.designs.direction);
    low_.assign(problem_.objectives, std::numeric_limits<double>::infinity());
    high_.assign(problem_.objectives, -std::numeric_limits<double>::infinity());
    has_volume_ = !front.empty() && problem_.objectives <= kMaxVolume;
    if (front.empty()) return;
    for (std::size_t k = 0; k < problem_.objectives; ++k) {
      std::size_t best = front.front();
      for (const std::size_t design : front) {
        low_[k] = std::min(low_[k], cost(design, k));
        high_[k] = std::max(high_[k], cost(design, k));
        if (cost(design, k) < cost(best, k)) best = design;
      }
      const std::size_t output = designs_.objectives[k];
      found_.chosen.push_back({(plan_.designs.direction[output] < 0 ? "lowest " : "largest ") +
                                   plan_.designs.outputs[output].name,
                               best});
    }
    if (problem_.objectives == 1) return;
    const auto distance = [&](std::size_t design) {
      double sum = 0;
      for (std::size_t k = 0; k < problem_.objectives; ++k)
        if (high_[k] > low_[k])
          sum += std::pow((cost(design, k) - low_[k]) / (high_[k] - low_[k]), 2);
      return sum;
    };
    found_.chosen.push_back(
        {"balanced", *std::min_element(front.begin(), front.end(),
                                       [&](auto a, auto b) { return distance(a) < distance(b); })});
  }

  // That the allowed ones of some points dominate. @param costs  of these points, as the search
  // has them
  double volume_of(std::span<const double> costs, std::span<const double> violations) const {
    std::vector<double> shares;
    for (std::size_t i = 0; i < violations.size(); ++i) {
      if (violations[i] > 0) continue;
      for (std::size_t k = 0; k < problem_.objectives; ++k) {
        const double width = high_[k] - low_[k];
        const double above = costs[i * problem_.numbers() + k] - low_[k];
        shares.push_back(width > 0 ? above / width : above);
      }
    }
    // A tenth beyond its worst point, so that the ends of the front count.
    return hypervolume(shares, std::vector<double>(problem_.objectives, 1.1));
  }

  // How much of the front each search finds alone.
  void compare_restarts() {
    if (!has_volume_) return;
    whole_ = volume_of(numbers_, found_.violations);
    std::size_t from = 0;
    for (std::size_t i = 0; i < plan_.search.restarts; ++i) {
      const std::size_t count = found_.search.evaluations[i], width = problem_.numbers();
      found_.shares_of_front.push_back(
          volume_of(std::span<const double>(numbers_).subspan(from * width, count * width),
                    std::span<const double>(found_.violations).subspan(from, count)) /
          whole_);
      from += count;
    }
  }

  SearchComparison compared_with(bool is_grid) {
    const std::size_t n = problem_.variables(), width = problem_.numbers();
    const std::vector<double> points =
        is_grid ? grid_search_points(problem_, found_.designs.designs)
                : random_search_points(problem_, found_.designs.designs, plan_.search.seed);
    SearchComparison one;
    one.name = is_grid ? "grid" : "random";
    one.evaluations = points.size() / n;
    one.best.assign(problem_.objectives, not_computed());
    std::vector<double> costs(one.evaluations * width), violations;
    const Stopwatch evaluation;
    for (std::size_t from = 0; from < one.evaluations; from += plan_.search.population) {
      const std::size_t count = std::min(plan_.search.population, one.evaluations - from);
      const SweepBlock block =
          block_at(count, std::span<const double>(points).subspan(from * n, count * n), false);
      for (std::size_t i = 0; i < count; ++i) {
        const auto row = std::span<double>(costs).subspan((from + i) * width, width);
        designs_.numbers_of(raw_of(block, i), row);
        violations.push_back(violation(problem_, row));
        if (violations.back() > 0) continue;
        ++one.feasible;
        for (std::size_t k = 0; k < problem_.objectives; ++k) {
          const int direction = plan_.designs.direction[designs_.objectives[k]];
          const double value = -direction * row[k];
          if (!is_computed(one.best[k]) || direction * (value - one.best[k]) > 0)
            one.best[k] = value;
        }
      }
    }
    one.seconds = evaluation.seconds();
    one.share_of_front = has_volume_ ? volume_of(costs, violations) / whole_ : not_computed();
    return one;
  }

  const DesignProblem& designs_;
  const OptimisePlan& plan_;
  const Progress& progress_;
  std::size_t raw_;  // numbers that are computed of a design
  DesignBatches batches_;
  SearchProblem problem_;
  Optimisation found_;
  std::vector<double> numbers_;     // costs and constraints of all designs
  std::vector<double> low_, high_;  // costs of the front, of each objective
  bool has_volume_ = false;
  double whole_ = 0;  // volume of the front
};

}  // namespace

Optimisation run_search(const DesignProblem& designs, const OptimiseWork& work,
                        const Progress& progress) {
  return SearchRun(designs, work, progress).make(work.rank == 0);
}

}  // namespace bentaxis::designs

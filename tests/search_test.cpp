// Problems of the literature whose optima are known in closed form. Thresholds were set before the
// first run: a front holds 99 % of the volume of the true one, an optimum 1e-6 of its cost.
#include "bentaxis/designs/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "bentaxis/designs/pareto.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::designs {
namespace {

constexpr double kOfVolume = 0.99, kOfCost = 1e-6;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Function = std::function<std::vector<double>(std::span<const double>)>;

// What was evaluated, with the problem made of one function.
struct Recorded {
  SearchProblem problem;
  std::vector<double> points, results;

  Recorded(std::vector<double> low, std::vector<double> high, std::size_t objectives,
           std::size_t constraints, Function function) {
    problem.low = std::move(low);
    problem.high = std::move(high);
    problem.whole.assign(problem.low.size(), false);
    problem.objectives = objectives;
    problem.constraints = constraints;
    problem.evaluate = [this, f = std::move(function)](
                           std::size_t count, std::span<const double> xs, std::span<double> rows) {
      const std::size_t n = problem.variables();
      for (std::size_t i = 0; i < count; ++i) {
        const auto row = f(xs.subspan(i * n, n));
        std::copy(row.begin(), row.end(),
                  rows.begin() + static_cast<std::ptrdiff_t>(i * problem.numbers()));
      }
      points.insert(points.end(), xs.begin(), xs.end());
      results.insert(results.end(), rows.begin(), rows.end());
    };
  }

  // Costs of the allowed points, row by row.
  std::vector<double> allowed() const {
    std::vector<double> costs;
    for (std::size_t i = 0; i < results.size(); i += problem.numbers()) {
      const auto row = std::span(results).subspan(i, problem.numbers());
      if (violation(problem, row) == 0)
        costs.insert(costs.end(), row.begin(),
                     row.begin() + static_cast<std::ptrdiff_t>(problem.objectives));
    }
    return costs;
  }
  double least(std::size_t objective = 0) const {
    double best = std::numeric_limits<double>::infinity();
    const auto costs = allowed();
    for (std::size_t i = objective; i < costs.size(); i += problem.objectives)
      best = std::min(best, costs[i]);
    return best;
  }
};

double volume(const std::vector<double>& costs) {
  const std::vector<double> reference = {1.1, 1.1};
  return hypervolume(costs, reference);
}

// E. Zitzler, K. Deb, L. Thiele, Comparison of multiobjective evolutionary algorithms, 2000.
std::vector<double> zdt(int number, std::span<const double> x) {
  const double rest = std::accumulate(x.begin() + 1, x.end(), 0.0);
  const double g = 1 + 9 * rest / static_cast<double>(x.size() - 1), f = x[0];
  if (number == 1) return {f, g * (1 - std::sqrt(f / g))};
  if (number == 2) return {f, g * (1 - f * f / g / g)};
  return {f, g * (1 - std::sqrt(f / g) - f / g * std::sin(10 * std::numbers::pi * f))};
}

TEST(SearchTest, FindsTheFrontsOfZdt) {
  for (const int number : {1, 2, 3}) {
    Recorded zdt_problem(std::vector<double>(30, 0), std::vector<double>(30, 1), 2, 0,
                         [=](auto x) { return zdt(number, x); });
    search(zdt_problem.problem, {},
           {.population = 100, .generations = 250, .restarts = 1, .refine = false});
    std::vector<double> truth;
    for (int i = 0; i <= 20000; ++i) {
      std::vector<double> x(30, 0);
      x[0] = i / 20000.0;
      const auto row = zdt(number, x);
      truth.insert(truth.end(), row.begin(), row.end());
    }
    EXPECT_GT(volume(zdt_problem.allowed()), kOfVolume * volume(truth)) << "ZDT" << number;
  }
}

TEST(SearchTest, VolumeIsThatOfClosedForm) {
  std::vector<double> front;
  for (int i = 0; i <= 20000; ++i) {
    const double f = i / 20000.0;
    front.insert(front.end(), {f, 1 - std::sqrt(f)});
  }
  EXPECT_NEAR(volume(front), 1.1 * 0.1 + 0.1 + 2.0 / 3, 1e-4);
  EXPECT_EQ(hypervolume(std::vector<double>{2.0, 3.0, 5.0}, std::vector<double>{4.0}), 2.0);
  EXPECT_EQ(volume({1.2, 0.5}), 0.0);
}

// CONSTR (K. Deb and others, NSGA-II, 2002): the front lies on a constraint where x < 2/3, there
// f2 = 7 / x - 9, and on the bound y = 0 beyond, f2 = 1 / x.
TEST(SearchTest, FindsAFrontThatLiesOnAConstraint) {
  Recorded constr({0.1, 0}, {1, 5}, 2, 2, [](auto x) {
    return std::vector<double>{x[0], (1 + x[1]) / x[0], (6 - x[1] - 9 * x[0]) / 6,
                               1 + x[1] - 9 * x[0]};
  });
  search(constr.problem, {}, {.population = 100, .generations = 100, .restarts = 1});
  std::vector<double> truth;
  for (int i = 0; i <= 20000; ++i) {
    const double x = 7.0 / 18 + (1 - 7.0 / 18) * i / 20000;
    truth.insert(truth.end(), {x, x < 2.0 / 3 ? 7 / x - 9 : 1 / x});
  }
  const std::vector<double> reference = {1.1, 10};
  const double found = hypervolume(constr.allowed(), reference);
  const double all = hypervolume(truth, reference);
  EXPECT_GT(found, kOfVolume * all);
  EXPECT_LE(found, all * (1 + 1e-4));
  EXPECT_NEAR(constr.least(0), 7.0 / 18, kOfCost);  // a corner of two constraints
  EXPECT_NEAR(constr.least(1), 1, kOfCost);
}

// Rosenbrock's function in a disc (x - 1)^3 - y + 1 <= 0, x + y <= 2: its least value is at (1, 1).
TEST(SearchTest, OneObjectiveEndsAtItsOptimum) {
  Recorded rosenbrock({-1.5, -0.5}, {1.5, 2.5}, 1, 2, [](auto x) {
    const double a = 1 - x[0], b = x[1] - x[0] * x[0], c = x[0] - 1;
    return std::vector<double>{a * a + 100 * b * b + 1, c * c * c - x[1] + 1, x[0] + x[1] - 2};
  });
  const SearchResult found = search(rosenbrock.problem, {}, {.population = 64, .generations = 40});
  EXPECT_NEAR(rosenbrock.least(), 1, kOfCost);
  ASSERT_GT(found.refinements.size(), 1U);  // another optimum lies at (0, 0)
  EXPECT_FALSE(found.refinements[0].exact);
  EXPECT_LE(found.refinements[0].after, found.refinements[0].before);
}

TEST(SearchTest, UsesExactDerivativesWhereThereAreSome) {
  Recorded bowl({-3, -3}, {2, 2}, 1, 1, [](auto x) {
    return std::vector<double>{(x[0] - 1) * (x[0] - 1) + x[1] * x[1] + 1, 1 - x[0] - x[1]};
  });
  int asked = 0;
  bowl.problem.differentiate = [&](std::span<const double> x, std::span<double> j) {
    ++asked;
    j[0] = 2 * (x[0] - 1);
    j[1] = 2 * x[1];
    j[2] = j[3] = -1;
    return true;
  };
  const SearchResult found =
      search(bowl.problem, {}, {.population = 8, .generations = 3, .restarts = 1});
  EXPECT_GT(asked, 0);
  EXPECT_TRUE(found.refinements.at(0).exact);
  EXPECT_NEAR(bowl.least(), 1, kOfCost);
}

TEST(SearchTest, WholeNumbersAreWhole) {
  // Least at x = 3, n = 4 where n is whole: 0.09 + (0.5 - ..)^2.
  Recorded mixed({0, 0}, {10, 10}, 1, 0, [](auto x) {
    return std::vector<double>{(x[0] - 3) * (x[0] - 3) + (x[1] - 4.3) * (x[1] - 4.3)};
  });
  mixed.problem.whole = {false, true};
  search(mixed.problem, {}, {.population = 64, .generations = 30});
  for (std::size_t i = 1; i < mixed.points.size(); i += 2)
    ASSERT_EQ(mixed.points[i], std::round(mixed.points[i]));
  EXPECT_NEAR(mixed.least(), 0.09, kOfCost);
  Recorded front({0, 0}, {10, 10}, 2, 0, [](auto x) {
    return std::vector<double>{x[0], (x[1] - 4.3) * (x[1] - 4.3) - x[0]};
  });
  front.problem.whole = {true, false};  // the whole one comes first here
  search(front.problem, {}, {.population = 16, .generations = 20});
  for (std::size_t i = 0; i < front.points.size(); i += 2)
    ASSERT_EQ(front.points[i], std::round(front.points[i]));
  EXPECT_EQ(front.least(0), 0);
}

TEST(SearchTest, EveryAllowedPointBeatsAnyOther) {
  // Allowed in 1 % of the range alone, where the cost is the largest of all; half has no values.
  Recorded narrow({0, 0}, {1, 1}, 2, 1, [](auto x) {
    if (x[1] > 0.5) return std::vector<double>{kNone, kNone, kNone};
    return std::vector<double>{x[0], 2 - x[0] + x[1], 0.99 - x[0]};
  });
  search(narrow.problem, {}, {.population = 32, .generations = 40});
  EXPECT_GT(narrow.allowed().size(), 2 * 32U);
  EXPECT_NEAR(narrow.least(0), 0.99, kOfCost);
}

TEST(SearchTest, SaysThatNothingIsAllowed) {
  Recorded none({0}, {1}, 1, 1, [](auto x) { return std::vector<double>{x[0], 1 + x[0]}; });
  const SearchResult found = search(none.problem, {}, {.population = 8, .generations = 5});
  EXPECT_TRUE(none.allowed().empty());
  EXPECT_TRUE(std::isnan(found.refinements.at(0).after));
  Recorded broken({0}, {1}, 1, 0, [](auto) { return std::vector<double>{kNone}; });
  EXPECT_TRUE(search(broken.problem, {}, {.population = 8, .generations = 5}).refinements.empty());
}

TEST(SearchTest, TheSameSeedGivesTheSamePoints) {
  const auto run = [](std::uint64_t seed) {
    Recorded problem({0, 0}, {1, 1}, 2, 0, [](auto x) {
      return std::vector<double>{x[0] + x[1], 1 - x[0]};
    });
    const std::vector<double> start = {0.25, 0.75};
    search(problem.problem, start,
           {.population = 8, .generations = 6, .restarts = 2, .seed = seed});
    EXPECT_EQ(problem.points[0], 0.25);
    EXPECT_EQ(problem.points[1], 0.75);
    return problem.points;
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
}

TEST(SearchTest, WhatEvaluationThrowsEndsTheSearch) {
  // At the first batch, and on the way of the refinement.
  for (const int last : {0, 8, 60}) {
    int count = 0;
    Recorded problem({0}, {1}, 1, 0, [&](auto x) {
      if (count++ >= last) throw ComputationError("ended by hand");
      return std::vector<double>{(x[0] - 0.3) * (x[0] - 0.3)};
    });
    EXPECT_THROW(search(problem.problem, {}, {.population = 8, .generations = 5, .restarts = 1}),
                 ComputationError)
        << last;
  }
}

TEST(SearchTest, RefusesImpossibleOptions) {
  Recorded problem({0}, {1}, 1, 0, [](auto x) { return std::vector<double>{x[0]}; });
  EXPECT_THROW(search(problem.problem, {}, {.population = 10}), InputError);
  EXPECT_THROW(search(problem.problem, {}, {.population = 4}), InputError);
  EXPECT_THROW(search(problem.problem, {}, {.restarts = 0}), InputError);
  problem.problem.high = {0};
  EXPECT_THROW(search(problem.problem, {}, {}), InputError);
}

TEST(SearchPoints, FillTheRangesWithNoMoreThanWasAskedFor) {
  SearchProblem problem;
  problem.low = {0, -1, 2};
  problem.high = {1, 1, 4};
  problem.whole = {false, false, true};  // of three values
  const std::vector<double> points = grid_search_points(problem, 100);
  // 5 x 6 x 3 or 6 x 5 x 3: one value more of any variable would be too many.
  ASSERT_EQ(points.size(), 3U * 90);
  std::set<double> first, second, third;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    first.insert(points[i]);
    second.insert(points[i + 1]);
    third.insert(points[i + 2]);
  }
  EXPECT_EQ(first.size() * second.size(), 30U);
  EXPECT_EQ(third, (std::set<double>{2, 3, 4}));
  EXPECT_EQ(*first.begin(), 0);
  EXPECT_EQ(*first.rbegin(), 1);
  EXPECT_EQ(*second.begin(), -1);
  EXPECT_EQ(*second.rbegin(), 1);
  EXPECT_EQ(grid_search_points(problem, 1), (std::vector<double>{0.5, 0, 3}));

  const std::vector<double> drawn = random_search_points(problem, 3000, 7);
  ASSERT_EQ(drawn.size(), 9000U);
  EXPECT_EQ(drawn, random_search_points(problem, 3000, 7));
  EXPECT_NE(drawn, random_search_points(problem, 3000, 8));
  double mean = 0;
  std::size_t low = 0;
  for (std::size_t i = 0; i < drawn.size(); i += 3) {
    EXPECT_TRUE(drawn[i] >= 0 && drawn[i] <= 1 && std::abs(drawn[i + 1]) <= 1);
    EXPECT_TRUE(drawn[i + 2] == 2 || drawn[i + 2] == 3 || drawn[i + 2] == 4);
    mean += drawn[i] / 3000;
    low += drawn[i + 2] == 2 ? 1 : 0;
  }
  EXPECT_NEAR(mean, 0.5, 5 * 0.289 / std::sqrt(3000.0));
  EXPECT_NEAR(static_cast<double>(low), 1000, 5 * std::sqrt(3000 * 2.0 / 9));
}

}  // namespace
}  // namespace bentaxis::designs

// Least squares against the certified values of NIST's Statistical Reference Datasets (nonlinear
// regression: Misra1a, Thurber, Hahn1). Observations and certified values are those of public
// copies of NIST's files; that the fits meet the certified values confirms both.
#include "bentaxis/designs/least_squares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::designs {
namespace {

using Numbers = std::vector<double>;

struct Certified {
  std::string name;
  std::vector<Numbers> starts;
  Numbers parameters, deviations;
  double sum_of_squares, residual_deviation;
  double (*model)(double x, std::span<const double> b);
};
// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest asks for this name
void PrintTo(const Certified& c, std::ostream* out) { *out << c.name; }

double saturation(double x, std::span<const double> b) { return -b[0] * std::expm1(-b[1] * x); }
double rational(double x, std::span<const double> b) {
  return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1 + x * (b[4] + x * (b[5] + x * b[6])));
}

const Certified kCertified[] = {
    {"Misra1a",
     {{500, 1e-4}, {250, 5e-4}},
     {2.3894212918e+02, 5.5015643181e-04},
     {2.7070075241e+00, 7.2668688436e-06},
     1.2455138894e-01,
     1.0187876330e-01,
     saturation},
    {"Thurber",
     {{1000, 1000, 400, 40, 0.7, 0.3, 0.03}, {1300, 1500, 500, 75, 1, 0.4, 0.05}},
     {1.2881396800e+03, 1.4910792535e+03, 5.8323836877e+02, 7.5416644291e+01, 9.6629502864e-01,
      3.9797285797e-01, 4.9727297349e-02},
     {4.6647963344e+00, 3.9571156086e+01, 2.8698696102e+01, 5.5675370270e+00, 3.1333340687e-02,
      1.4984928198e-02, 6.5842344623e-03},
     5.6427082397e+03,
     1.3714600784e+01,
     rational},
    {"Hahn1",
     {{10, -1, .05, -1e-5, -.05, .001, -1e-6}, {1, -.1, .005, -1e-6, -.005, 1e-4, -1e-7}},
     {1.0776351733e+00, -1.2269296921e-01, 4.0863750610e-03, -1.4262662514e-06, -5.7609940901e-03,
      2.4053735503e-04, -1.2314450199e-07},
     {1.7070154742e-01, 1.2000289189e-02, 2.2508314937e-04, 2.7578037666e-07, 2.4712888219e-04,
      1.0449373768e-05, 1.3027335327e-08},
     1.5324382854e+00,
     8.1803852243e-02,
     rational}};

LeastSquaresProblem problem_of(const Certified& c) {
  const NumericTable data =
      read_numeric_csv(std::string(BENTAXIS_SOURCE_DIR "/tests/nist/") + c.name + ".csv");
  LeastSquaresProblem problem;
  problem.parameters = c.parameters.size();
  problem.residuals = data.rows.size();
  problem.evaluate = [rows = data.rows, model = c.model](std::span<const double> x,
                                                         std::span<double> residuals) {
    for (std::size_t i = 0; i < rows.size(); ++i) residuals[i] = rows[i][1] - model(rows[i][0], x);
    return true;
  };
  return problem;
}

// Logarithm of the relative error: the certified digits that are met.
double digits(double found, double certified) {
  return -std::log10(std::max(std::abs(found / certified - 1), 1e-16));
}

class Nist : public testing::TestWithParam<Certified> {};
INSTANTIATE_TEST_SUITE_P(Datasets, Nist, testing::ValuesIn(kCertified),
                         [](const auto& dataset) { return dataset.param.name; });

TEST_P(Nist, BothStartsMeetTheCertifiedValuesTo8Digits) {
  if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  const Certified& c = GetParam();
  for (const Numbers& start : c.starts) {
    const LeastSquaresFit fit = least_squares(problem_of(c), start);
    EXPECT_TRUE(fit.converged) << fit.message;
    EXPECT_GE(digits(fit.sum_of_squares, c.sum_of_squares), 8);
    EXPECT_GE(digits(fit.residual_deviation(), c.residual_deviation), 8);
    const Numbers covariance = fit.covariance();
    const std::size_t n = c.parameters.size();
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_GE(digits(fit.x[i], c.parameters[i]), 8) << "b" << i + 1 << " = " << fit.x[i];
      const double deviation = fit.residual_deviation() * std::sqrt(covariance[i * n + i]);
      EXPECT_GE(digits(deviation, c.deviations[i]), 6) << "deviation of b" << i + 1;
    }
  }
}

TEST(LeastSquares, ManyStartsComeBestFirstAndDoNotDependOnThreads) {
  if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  // (x^2 - 1)^2 + 0.1 (x - 1)^2: its smaller minimum is 0 at 1, the other near -1.
  LeastSquaresProblem problem;
  problem.parameters = 1;
  problem.residuals = 2;
  problem.evaluate = [](std::span<const double> x, std::span<double> r) {
    if (x[0] > 2) return false;
    r[0] = x[0] * x[0] - 1;
    r[1] = std::sqrt(0.1) * (x[0] - 1);
    return true;
  };
  const std::vector<Numbers> starts = {{-1.5}, {3}, {0.3}, {-0.8}};
  const auto one = least_squares(problem, starts, {}, 1);
  const auto two = least_squares(problem, starts, {}, 2);
  ASSERT_EQ(one.size(), 3U) << "nothing can be computed at 3";
  EXPECT_NEAR(one[0].x[0], 1, 1e-9);
  EXPECT_NEAR(one[1].x[0], one[2].x[0], 1e-6);
  EXPECT_LT(one[1].x[0], -0.9);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(one[i].x, two[i].x);
}

TEST(LeastSquares, ABoundIsKeptAndItsDerivativesAreOneSided) {
  if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  LeastSquaresProblem problem;
  problem.parameters = 2;
  problem.residuals = 2;
  problem.low = {0, 0};
  problem.high = {1, 10};
  problem.evaluate = [&](std::span<const double> x, std::span<double> r) {
    for (std::size_t i = 0; i < 2; ++i)
      if (x[i] < problem.low[i] || x[i] > problem.high[i]) return false;
    r[0] = x[0] * x[0] - 4;  // would be met at 2, beyond the bound
    r[1] = x[0] + x[1] - 5;
    return true;
  };
  const Numbers start = {0.5, 1};
  const LeastSquaresFit fit = least_squares(problem, start);
  EXPECT_DOUBLE_EQ(fit.x[0], 1);
  EXPECT_NEAR(fit.x[1], 4, 1e-8);
  EXPECT_NEAR(fit.jacobian[0], 2, 1e-9);
}

// What lies beyond a bound may have no value, or one of another law.
TEST(LeastSquares, DerivativesAskForNothingBeyondABound) {
  LeastSquaresProblem problem;
  problem.parameters = problem.residuals = 1;
  problem.low = {1};
  problem.high = {2};
  int beyond = 0;
  problem.evaluate = [&](std::span<const double> x, std::span<double> r) {
    if (x[0] < 1 || x[0] > 2) ++beyond;
    r[0] = x[0] * x[0];
    return true;
  };
  for (const double x : {1.0, 1.5, 2.0}) {
    Numbers slope(1);
    ASSERT_TRUE(derivatives_of(problem, Numbers{x}, slope));
    EXPECT_NEAR(slope[0], 2 * x, 1e-8) << "at " << x;
  }
  EXPECT_EQ(beyond, 0);
}

// Rounding leaves a parameter a hair off 0: a step of its own size would move nothing.
TEST(LeastSquares, AParameterThatIsAlmostZeroHasItsDerivatives) {
  LeastSquaresProblem problem;
  problem.parameters = problem.residuals = 1;
  problem.low = {-1};
  problem.high = {300};
  problem.evaluate = [](std::span<const double> x, std::span<double> r) {
    r[0] = 10 * (275 - x[0]);
    return true;
  };
  for (const double x : {0.0, 1e-300, 1e-14, -3e-12, 1e-6}) {
    Numbers slope(1);
    ASSERT_TRUE(derivatives_of(problem, Numbers{x}, slope));
    EXPECT_NEAR(slope[0], -10, 1e-6) << "at " << x;
    if (least_squares_library().empty()) continue;
    EXPECT_NEAR(least_squares(problem, Numbers{x}).x[0], 275, 1e-9) << "from " << x;
  }
}

TEST(LeastSquares, WhatTheDataDoNotDetermineHasNoCovariance) {
  LeastSquaresFit fit;
  fit.x = {1, 2};
  fit.residuals = {0, 0};
  fit.jacobian = {1, 1, 2, 2};
  EXPECT_THROW((void)fit.covariance(), ComputationError);
}

}  // namespace
}  // namespace bentaxis::designs

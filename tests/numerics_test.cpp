// Methods without physics: jobs side by side, and objects that are used again.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/numerics/object_pool.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/numerics/stiff_integrator.h"

namespace bentaxis::numerics {
namespace {

TEST(ParallelFor, CallsEveryJobOnce) {
  for (const int threads : {0, 1, 2, 1000}) {
    for (const std::size_t count : {0U, 1U, 257U}) {
      std::vector<int> calls(count, 0);
      parallel_for(threads, count, [&](std::size_t i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(count, 1)) << threads;
    }
  }
}

TEST(ParallelFor, OneThreadIsOneThread) {
  std::atomic<int> running{0}, most{0};
  parallel_for(1, 50, [&](std::size_t) {
    most = std::max<int>(most, ++running);
    std::this_thread::yield();
    --running;
  });
  EXPECT_EQ(most, 1);
}

TEST(ParallelFor, JobsMayHaveJobs) {
  std::atomic<int> calls{0};
  parallel_for(2, 5, [&](std::size_t) { parallel_for(2, 7, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls, 35);
}

TEST(ParallelFor, AnExceptionReachesTheCallerAndTheNextCallWorks) {
  for (int i = 0; i < 3; ++i)
    EXPECT_THROW(parallel_for(2, 20,
                              [](std::size_t job) {
                                // Time for every thread to take a job.
                                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                if (job == 7) throw std::runtime_error("job 7");
                              }),
                 std::runtime_error);
  std::atomic<int> calls{0};
  parallel_for(2, 20, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 20);
}

TEST(ObjectPool, GivesBackWhatIsUnusedAndMakesWhatLacks) {
  ObjectPool<int> pool;
  int made = 0;
  const auto make = [&] { return ++made; };
  auto first = pool.take(make), second = pool.take(make);
  EXPECT_EQ(*first, 1);
  EXPECT_EQ(*second, 2);
  const int* const address = first.get();
  pool.give_back(std::move(first));
  const auto again = pool.take(make);
  EXPECT_EQ(again.get(), address);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(*pool.take(make), 3);
}

TEST(Bisection, HalvesABracketAroundTheRoot) {
  const auto is_above = [](double x) { return x * x > 2; };
  const Bracket root = bisect({1, 2}, 60, is_above);
  EXPECT_LE(root.low, root.high);
  EXPECT_NEAR(root.middle(), std::sqrt(2.0), 1e-15);
  const Bracket coarse = bisect({1, 2}, 3, is_above);
  EXPECT_EQ(coarse.low, 1.375);
  EXPECT_EQ(coarse.high, 1.5);
  EXPECT_EQ(bisect({1, 2}, 0, is_above).middle(), 1.5);
}

// y' = -k (y - cos t), with the integral of y and the sensitivity by k.
class Relaxation : public Equations {
 public:
  static constexpr double kRate = 1000;
  int states() const override { return 1; }
  int integrals() const override { return 1; }
  bool rates(double t, const double* y, double* dy) override {
    *dy = -kRate * (*y - std::cos(t));
    return true;
  }
  void jacobian(double, const double*, const double*, bool, double* by_state) override {
    *by_state = -kRate;
  }
  void integrands(double, const double* y, double* dq) override { *dq = *y; }
  bool sensitivity_rates(double t, const double* y, const std::vector<const double*>& s,
                         const std::vector<double*>& ds) override {
    *ds[0] = -kRate * *s[0] - (*y - std::cos(t));
    return true;
  }
  // What remains of the solution once the start is forgotten.
  static double solution(double t, double k = kRate) {
    return k * (k * std::cos(t) + std::sin(t)) / (k * k + 1);
  }
};

TEST(StiffIntegrator, IntegratesStatesIntegralsAndSensitivities) {
  Relaxation equations;
  StiffIntegrator integrator(equations, 1e-10, {1, 1e-10, true});
  integrator.start(0, {Relaxation::solution(0)}, {0}, {0});
  while (integrator.step(1) != StiffIntegrator::Reached::stop) {
  }
  integrator.restart();  // as at an edge: what was reached stays
  while (integrator.step(2) != StiffIntegrator::Reached::stop) {
  }
  EXPECT_EQ(integrator.time(), 2);
  constexpr double kError = 1e-7;  // of a thousand steps
  EXPECT_NEAR(*integrator.state_at(2), Relaxation::solution(2), kError);
  const double k = Relaxation::kRate;
  const double integral = k * (k * std::sin(2) + 1 - std::cos(2)) / (k * k + 1);
  EXPECT_NEAR(*integrator.integrals_at(2), integral, kError);
  const double by_k = (Relaxation::solution(2, k + 1) - Relaxation::solution(2, k - 1)) / 2;
  EXPECT_NEAR(integrator.sensitivities_at(2)[0] / by_k, 1, 1e-4);
}

// y' = 1; the first trial beyond a time throws, and from `broken` on no rate is finite.
class Obstacle : public Equations {
 public:
  int states() const override { return 1; }
  std::vector<int> event_functions() const override { return {1}; }
  bool rates(double t, const double*, double* dy) override {
    *dy = 1;
    if (t > 0.5 && !thrown) {
      thrown = true;
      throw std::runtime_error("too far");
    }
    return !broken;
  }
  void jacobian(double, const double*, const double*, bool, double* by_state) override {
    *by_state = 0;
  }
  void event_values(double, const double* y, double* values) override { *values = *y - 0.25; }
  bool is_recoverable(const std::exception&) const override { return recoverable; }

  bool thrown = false, recoverable = true, broken = false;
};

TEST(StiffIntegrator, ForgetsWhatAShorterStepHasAvoided) {
  Obstacle equations;
  StiffIntegrator integrator(equations, 1e-6);
  integrator.start(0, {0});
  EXPECT_TRUE(integrator.complaint().empty());
  bool event = false;
  try {
    while (integrator.time() < 3) {
      event |= integrator.step(3) == StiffIntegrator::Reached::event;
      equations.broken = integrator.time() > 1;
    }
    FAIL() << "went on";
  } catch (const IntegrationFailure& failure) {  // and not the exception of long ago
    EXPECT_EQ(failure.reason(), IntegrationFailure::Reason::no_rates);
  }
  EXPECT_TRUE(event);
  EXPECT_TRUE(equations.thrown);
  EXPECT_GT(integrator.time(), 1);
  EXPECT_EQ(integrator.complaint(), "too far");
  integrator.forget_complaint();
  EXPECT_TRUE(integrator.complaint().empty());
}

TEST(StiffIntegrator, ThrowsOnWhatNoShorterStepAvoids) {
  Obstacle equations;
  equations.recoverable = false;
  StiffIntegrator integrator(equations, 1e-6);
  integrator.start(0, {0});
  try {
    while (integrator.time() < 2) integrator.step(2);
    FAIL() << "went on";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "too far");
  }
}

// y' = -k (y - cos t) with a matrix of the wrong sign until it is asked for again.
class WrongAtFirst : public Relaxation {
 public:
  void jacobian(double, const double*, const double*, bool again, double* by_state) override {
    asked_again |= again;
    if (calls++ == 0) {
      EXPECT_FALSE(again) << "before Newton's method has failed";
    }
    *by_state = asked_again ? -kRate : 1e3 * kRate;
  }
  int calls = 0;
  bool asked_again = false;
};

TEST(StiffIntegrator, AsksForTheMatrixAgainWhereNewtonsMethodFailed) {
  WrongAtFirst equations;
  StiffIntegrator integrator(equations, 1e-8);
  integrator.start(0, {0.5});
  while (integrator.step(1) != StiffIntegrator::Reached::stop) {
  }
  EXPECT_TRUE(equations.asked_again);
  EXPECT_NEAR(*integrator.state_at(1), Relaxation::solution(1), 1e-6);

  struct Right : Relaxation {
    void jacobian(double t, const double* y, const double* dy, bool again,
                  double* by_state) override {
      EXPECT_FALSE(again) << "of a matrix that is right, at " << t;
      Relaxation::jacobian(t, y, dy, again, by_state);
    }
  } right;
  StiffIntegrator other(right, 1e-8);
  other.start(0, {0.5});
  while (other.step(1) != StiffIntegrator::Reached::stop) {
  }
}

Eigen::MatrixXd matrix_of(std::initializer_list<std::initializer_list<double>> rows) {
  return Eigen::MatrixXd(rows);
}

TEST(Dense, SolvesWhatHasOneSolution) {
  const Eigen::MatrixXd a = matrix_of({{0, 2, 1}, {4, -6, 0}, {-2, 7, 3}});
  const Eigen::VectorXd x = Eigen::Vector3d(1, -2, 3);
  const LinearSolver solver(a);
  EXPECT_LT((solver.solve(Eigen::VectorXd(a * x)) - x).norm(), 1e-14);
  const Eigen::MatrixXd both = matrix_of({{1, 5}, {-2, 0}, {3, -1}});
  EXPECT_LT((solver.solve(Eigen::MatrixXd(a * both)) - both).norm(), 1e-13);
  const Eigen::MatrixXd square = a.transpose() * a;
  EXPECT_LT((SymmetricSolver(square).solve(Eigen::VectorXd(square * x)) - x).norm(), 1e-12);
  EXPECT_FALSE(LinearSolver(matrix_of({{1, 2}, {2, 4}}))
                   .solve(Eigen::VectorXd(Eigen::VectorXd::Unit(2, 0)))
                   .allFinite());
}

// The line through three points: normal equations by hand give 7/6 and 1/2.
TEST(Dense, FitsByLeastSquares) {
  const Eigen::MatrixXd a = matrix_of({{1, 0}, {1, 1}, {1, 2}});
  const Eigen::VectorXd b = Eigen::Vector3d(1, 2, 2);
  const LeastSquaresSolver solver(a);
  EXPECT_EQ(solver.rank(), 2);
  EXPECT_LT((solver.solve(b) - Eigen::VectorXd(Eigen::Vector2d(7.0 / 6, 0.5))).norm(), 1e-14);
  const Eigen::MatrixXd span = solver.span(), root = solver.inverse_root();
  ASSERT_EQ(span.cols(), 2);
  EXPECT_LT((span.transpose() * span - Eigen::MatrixXd::Identity(2, 2)).norm(), 1e-14);
  EXPECT_LT((a - span * (span.transpose() * a)).norm(), 1e-14);
  EXPECT_LT(
      (root * root.transpose() * (a.transpose() * a) - Eigen::MatrixXd::Identity(2, 2)).norm(),
      1e-13);
}

TEST(Dense, TakesTheShortestOfManySolutions) {
  const Eigen::MatrixXd a = matrix_of({{1, 1}, {2, 2}});
  const Eigen::VectorXd b = Eigen::Vector2d(2, 4);
  const ShortestSolver solver(a, 1e-10);
  EXPECT_LT((solver.solve(b) - Eigen::VectorXd::Ones(2)).norm(), 1e-14);
  EXPECT_LT((solver.pseudo_inverse() - matrix_of({{0.1, 0.2}, {0.1, 0.2}})).norm(), 1e-15);
  // What is below the threshold counts as dependent, above it as independent.
  const Eigen::MatrixXd almost = matrix_of({{1, 1}, {1, 1 + 1e-6}});
  EXPECT_LT(ShortestSolver(almost, 1e-3).pseudo_inverse().norm(), 1);
  EXPECT_GT(ShortestSolver(almost, 1e-9).pseudo_inverse().norm(), 1e5);
  EXPECT_EQ(LeastSquaresSolver(almost, 1e-3).rank(), 1);
  EXPECT_EQ(LeastSquaresSolver(almost, 1e-9).rank(), 2);
}

TEST(Dense, FindsEigenvalues) {
  const Eigen::VectorXcd turning = eigenvalues(matrix_of({{1, -2}, {2, 1}}));
  for (const auto& value : turning) {
    EXPECT_NEAR(value.real(), 1, 1e-14);
    EXPECT_NEAR(std::abs(value.imag()), 2, 1e-14);
  }
  EXPECT_LT(std::abs(turning.sum() - 2.0), 1e-14);
  const Eigen::MatrixXd symmetric = matrix_of({{2, 1}, {1, 2}});
  EXPECT_LT((symmetric_eigenvalues(symmetric) - Eigen::VectorXd(Eigen::Vector2d(1, 3))).norm(),
            1e-14);
  const SymmetricEigen found = symmetric_eigen(symmetric);
  EXPECT_LT((symmetric * found.vectors - found.vectors * found.values.asDiagonal()).norm(), 1e-14);
  EXPECT_NEAR(found.vectors.col(1).norm(), 1, 1e-14);
  EXPECT_LT(found.values[0], found.values[1]);
}

}  // namespace
}  // namespace bentaxis::numerics

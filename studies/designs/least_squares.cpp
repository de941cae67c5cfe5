#include "bentaxis/designs/least_squares.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "bentaxis/numerics/dense.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/reporting.h"
#include "row_major.h"

#ifdef BENTAXIS_HAS_CERES
#include <ceres/version.h>

#include "bentaxis/files/module.h"
#include "ceres_module.h"
#endif

namespace bentaxis::designs {
namespace {

// Of the longest column: what is shorter is the error of derivatives by differences.
constexpr double kRank = 1e-9;

// What a change of a parameter at x is small or large against: its value, but where that is hardly
// more than 0 (rounding leaves it a hair off) a share of the bounds' width.
double size_of(const LeastSquaresProblem& problem, std::size_t i, double x) {
  constexpr double kHardlyMore = 0.01;
  const double own = std::abs(x);
  if (!problem.low.empty() && std::isfinite(problem.high[i] - problem.low[i]))
    return std::max(own, kHardlyMore * (problem.high[i] - problem.low[i]));
  return own > 0 ? own : 1;
}

// One column of the derivatives, by differences of second order.
class Differences {
 public:
  Differences(const LeastSquaresProblem& problem, std::span<const double> x)
      : problem_(problem), x_(x.begin(), x.end()), centre_(problem.residuals) {}

  bool column(std::size_t i, std::span<double> jacobian) {
    // Where the errors of rounding and of the cut-off series meet.
    const double share = std::cbrt(std::numeric_limits<double>::epsilon());
    const double step = share * size_of(problem_, i, x_[i]);
    const auto ahead = at(i, step), behind = at(i, -step);
    const std::size_t n = problem_.parameters;
    if (ahead && behind) {
      for (std::size_t r = 0; r < problem_.residuals; ++r)
        jacobian[r * n + i] = ((*ahead)[r] - (*behind)[r]) / (2 * step);
      return true;
    }
    if (!ahead && !behind) return false;
    const double side = ahead ? step : -step;
    const auto further = at(i, 2 * side);
    if (!further || !centre()) return false;
    const std::vector<double>& near = ahead ? *ahead : *behind;
    for (std::size_t r = 0; r < problem_.residuals; ++r)
      jacobian[r * n + i] = (4 * near[r] - 3 * centre_[r] - (*further)[r]) / (2 * side);
    return true;
  }

 private:
  std::optional<std::vector<double>> at(std::size_t i, double step) {
    const double middle = x_[i], moved = middle + step;
    if (!problem_.low.empty() && (moved < problem_.low[i] || moved > problem_.high[i]))
      return std::nullopt;
    std::vector<double> residuals(problem_.residuals);
    x_[i] = moved;
    const bool there = problem_.evaluate(x_, residuals);
    x_[i] = middle;
    if (!there) return std::nullopt;
    return residuals;
  }
  bool centre() {
    if (!have_centre_) have_centre_ = problem_.evaluate(x_, centre_);
    return have_centre_;
  }

  const LeastSquaresProblem& problem_;
  std::vector<double> x_, centre_;
  bool have_centre_ = false;
};

}  // namespace

double sum_of_squares(std::span<const double> residuals) {
  double sum = 0;
  for (const double r : residuals) sum += r * r;
  return sum;
}

double LeastSquaresFit::residual_deviation() const {
  const double freedom = static_cast<double>(residuals.size()) - static_cast<double>(x.size());
  return std::sqrt(sum_of_squares / freedom);
}

std::vector<double> LeastSquaresFit::covariance() const {
  const auto n = static_cast<Eigen::Index>(x.size());
  RowMajor j =
      Eigen::Map<const RowMajor>(jacobian.data(), static_cast<Eigen::Index>(residuals.size()), n);
  Eigen::VectorXd lengths = j.colwise().norm();  // so that units of parameters do not count
  for (double& length : lengths) length = length > 0 ? length : 1;
  j = j * lengths.cwiseInverse().asDiagonal();
  const numerics::LeastSquaresSolver qr(j, kRank);
  if (qr.rank() < n)
    throw ComputationError("least squares: the data do not determine all parameters");
  const Eigen::MatrixXd half = lengths.cwiseInverse().asDiagonal() * qr.inverse_root();
  std::vector<double> result(x.size() * x.size());
  Eigen::Map<RowMajor>(result.data(), n, n) = half * half.transpose();
  return result;
}

bool derivatives_of(const LeastSquaresProblem& problem, std::span<const double> x,
                    std::span<double> jacobian) {
  if (problem.differentiate) return problem.differentiate(x, jacobian);
  Differences differences(problem, x);
  for (std::size_t i = 0; i < problem.parameters; ++i)
    if (!differences.column(i, jacobian)) return false;
  return true;
}

#ifdef BENTAXIS_HAS_CERES
namespace {

// Ceres brings SuiteSparse, METIS and gflags: fifteen libraries, loaded where something is fitted.
auto* ceres_solver() {
  static const Module loaded(BENTAXIS_CERES_MODULE);
  return loaded.table<decltype(&bentaxis_ceres_solve)>("kBentaxisCeres", "least squares");
}

// Gauss-Newton steps, shortest where the data leave a choice, of the parameters that no bound
// holds. Where Ceres stops, the sum of squares is right to round-off, the parameters to half as
// many digits; and along a bound it may have stopped early, because its steps are cut off there.
void finish(const LeastSquaresProblem& problem, const std::vector<double>& units,
            const LeastSquaresOptions& options, LeastSquaresFit& fit) {
  constexpr double kRounding = 1e-13;
  const std::size_t n = problem.parameters, m = problem.residuals;
  double last = HUGE_VAL;
  for (int iteration = 0; iteration < options.most_iterations; ++iteration) {
    const Eigen::Map<const RowMajor> jacobian(fit.jacobian.data(), static_cast<Eigen::Index>(m),
                                              static_cast<Eigen::Index>(n));
    const Eigen::Map<const Eigen::VectorXd> residuals(fit.residuals.data(),
                                                      static_cast<Eigen::Index>(m));
    Eigen::MatrixXd free = jacobian;
    const Eigen::VectorXd slope = jacobian.transpose() * residuals;
    for (std::size_t i = 0; i < n; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const bool held =
          !problem.low.empty() && ((fit.x[i] <= problem.low[i] && slope[column] >= 0) ||
                                   (fit.x[i] >= problem.high[i] && slope[column] <= 0));
      free.col(column) *= held ? 0 : units[i];
    }
    const Eigen::VectorXd step = numerics::ShortestSolver(free, kRank).solve(-residuals);
    LeastSquaresFit next = fit;
    for (std::size_t i = 0; i < n; ++i) {
      next.x[i] += step[static_cast<Eigen::Index>(i)] * units[i];
      if (!problem.low.empty()) next.x[i] = std::clamp(next.x[i], problem.low[i], problem.high[i]);
    }
    if (!problem.evaluate(next.x, next.residuals)) return;
    next.sum_of_squares = sum_of_squares(next.residuals);
    // At the end of it only rounding is left in the sum, while steps still become shorter.
    const double length = step.norm();
    const bool better = next.sum_of_squares < fit.sum_of_squares * (1 - kRounding) - options.enough;
    const bool nearer =
        next.sum_of_squares <= fit.sum_of_squares * (1 + kRounding) && length < last / 2;
    if (!(better || (options.enough == 0 && nearer)) ||
        !derivatives_of(problem, next.x, next.jacobian))
      return;
    last = length;
    fit = std::move(next);
    ++fit.iterations;
  }
}

}  // namespace

std::string least_squares_library() { return "Ceres " CERES_VERSION_STRING; }

LeastSquaresFit least_squares(const LeastSquaresProblem& problem, std::span<const double> start,
                              const LeastSquaresOptions& options) {
  const std::size_t n = problem.parameters;
  LeastSquaresFit fit;
  fit.x.assign(start.begin(), start.end());
  fit.residuals.resize(problem.residuals);
  if (!problem.evaluate(fit.x, fit.residuals))
    throw ComputationError("least squares: the model cannot be computed at the start");
  std::vector<double> units(n), u(n);
  for (std::size_t i = 0; i < n; ++i) {
    units[i] = size_of(problem, i, fit.x[i]);
    u[i] = fit.x[i] / units[i];
  }
  CeresTask task;
  task.residuals = problem.residuals;
  task.options = options;
  for (std::size_t i = 0; i < n && !problem.low.empty(); ++i) {
    task.low.push_back(problem.low[i] / units[i]);
    task.high.push_back(problem.high[i] / units[i]);
  }
  task.evaluate = [&](const double* at, double* residuals, double* jacobian) {
    const std::size_t m = problem.residuals;
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = at[i] * units[i];
    if (!problem.evaluate(x, {residuals, m})) return false;
    if (jacobian == nullptr) return true;
    if (!derivatives_of(problem, x, {jacobian, m * n})) return false;
    for (std::size_t r = 0; r < m; ++r)
      for (std::size_t i = 0; i < n; ++i) jacobian[r * n + i] *= units[i];
    return true;
  };
  const CeresEnd end = ceres_solver()(task, u);
  // Times its unit a bound may come out a rounding beyond itself.
  for (std::size_t i = 0; i < n; ++i) {
    fit.x[i] = u[i] * units[i];
    if (!problem.low.empty()) fit.x[i] = std::clamp(fit.x[i], problem.low[i], problem.high[i]);
  }
  fit.converged = end.converged;
  fit.message = end.message;
  fit.iterations = end.iterations;
  fit.jacobian.resize(problem.residuals * n);
  if (!problem.evaluate(fit.x, fit.residuals) || !derivatives_of(problem, fit.x, fit.jacobian))
    throw ComputationError("least squares: the model cannot be computed at the solution");
  fit.sum_of_squares = sum_of_squares(fit.residuals);
  finish(problem, units, options, fit);
  return fit;
}
#else
std::string least_squares_library() { return ""; }

LeastSquaresFit least_squares(const LeastSquaresProblem&, std::span<const double>,
                              const LeastSquaresOptions&) {
  throw InputError(
      "identify: this program was built without Ceres; install libceres-dev (scripts/setup full) "
      "and build again");
}
#endif

namespace {

// How far fits are of which nobody knows how long they take: by their evaluations, of which the
// finished ones say how many a fit needs.
class FitProgress {
 public:
  FitProgress(const LeastSquaresProblem& problem, std::size_t fits, const Progress& progress)
      : fits_(static_cast<double>(fits)), progress_(progress) {
    constexpr double kIterations = 20;
    const auto n = static_cast<double>(problem.parameters);
    of_each_ = kIterations * (problem.differentiate ? 1 : 1 + 2 * n);
  }

  void evaluated() {
    const std::lock_guard lock(mutex_);
    ++evaluations_;
    tell();
  }
  void fitted() {
    const std::lock_guard lock(mutex_);
    of_each_ = evaluations_ / ++done_;
    tell();
  }

 private:
  void tell() const {
    if (!progress_) return;
    constexpr double kAlmost = 0.99;
    const double guess = std::min(kAlmost, evaluations_ / (of_each_ * fits_));
    progress_(std::max(done_ / fits_, guess));
  }

  std::mutex mutex_;
  double fits_, of_each_ = 0, evaluations_ = 0, done_ = 0;
  const Progress& progress_;
};

}  // namespace

std::vector<LeastSquaresFit> least_squares(const LeastSquaresProblem& problem,
                                           const std::vector<std::vector<double>>& starts,
                                           const LeastSquaresOptions& options, int threads,
                                           const Progress& progress) {
  std::vector<std::optional<LeastSquaresFit>> found(starts.size());
  FitProgress fits_progress(problem, starts.size(), progress);
  LeastSquaresProblem told = problem;
  told.evaluate = [&](std::span<const double> x, std::span<double> residuals) {
    fits_progress.evaluated();
    return problem.evaluate(x, residuals);
  };
  numerics::parallel_for(threads, starts.size(), [&](std::size_t i) {
    try {
      found[i] = least_squares(told, starts[i], options);
    } catch (const ComputationError&) {
      found[i].reset();  // no residuals there: a start like this leads nowhere
    }
    fits_progress.fitted();
  });
  std::vector<LeastSquaresFit> fits;
  for (auto& fit : found)
    if (fit) fits.push_back(std::move(*fit));
  std::stable_sort(fits.begin(), fits.end(),
                   [](const LeastSquaresFit& a, const LeastSquaresFit& b) {
                     return a.sum_of_squares < b.sum_of_squares;
                   });
  return fits;
}

}  // namespace bentaxis::designs

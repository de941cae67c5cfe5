// Nonlinear least squares with bounds: the core of identification. Knows no pump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/results/result_table.h"

namespace bentaxis::designs {

/// Residuals as a function of parameters, each over its standard uncertainty.
struct LeastSquaresProblem {
  std::size_t parameters = 0, residuals = 0;
  /// Fills `residuals`; false where there are none at x. Called by several threads.
  std::function<bool(std::span<const double> x, std::span<double> residuals)> evaluate;
  /// Derivatives, residuals x parameters, row by row; false where there are none. Empty: central
  /// differences of `evaluate`.
  std::function<bool(std::span<const double> x, std::span<double> jacobian)> differentiate = {};
  std::vector<double> low = {}, high = {};  ///< bounds, one per parameter; empty: none
};

double sum_of_squares(std::span<const double> residuals);

struct LeastSquaresFit {
  std::vector<double> x;
  std::vector<double> residuals;
  std::vector<double> jacobian;  ///< residuals x parameters at x, row by row
  double sum_of_squares = 0;
  int iterations = 0;
  bool converged = false;
  std::string message;  ///< of the solver

  /// Root of the sum of squares over residuals - parameters.
  double residual_deviation() const;
  /// Inverse of J'J, parameters x parameters, without the residual deviation.
  /// @throws ComputationError where the residuals do not determine all parameters
  std::vector<double> covariance() const;
};

struct LeastSquaresOptions {
  int most_iterations = 500;
  double tolerance = 1e-15;  ///< of the sum of squares, and of a step over the parameters
  double enough = 0;         ///< change of the sum of squares that does not matter; 0: all do
};

/// Whether this program was built with Ceres, and its version.
std::string least_squares_library();

/// Levenberg-Marquardt by Ceres (dense QR) from one start.
/// @throws InputError where the program was built without Ceres
/// @throws ComputationError where there are no residuals at the start
LeastSquaresFit least_squares(const LeastSquaresProblem& problem, std::span<const double> start,
                              const LeastSquaresOptions& options = {});

/// Derivatives of a problem's residuals at x: its own, or central differences, one-sided of second
/// order at a bound or beside a point that has no residuals. @return false where there are none
bool derivatives_of(const LeastSquaresProblem& problem, std::span<const double> x,
                    std::span<double> jacobian);

/// Fits from several starts, in threads; best first, those of equal sum in the order of the starts.
/// Starts that have no residuals, or end without, are left out.
std::vector<LeastSquaresFit> least_squares(const LeastSquaresProblem& problem,
                                           const std::vector<std::vector<double>>& starts,
                                           const LeastSquaresOptions& options, int threads,
                                           const Progress& progress = {});

}  // namespace bentaxis::designs

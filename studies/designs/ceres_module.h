// What is asked of Ceres, by the module that is linked with it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bentaxis/designs/least_squares.h"

namespace bentaxis::designs {

/// Residuals of parameters of the same size: a step that is small is small for every one of them.
struct CeresTask {
  std::size_t residuals = 0;
  /// Fills residuals and, where not null, derivatives (residuals x parameters, row by row); false
  /// where there are none.
  std::function<bool(const double* u, double* residuals, double* jacobian)> evaluate;
  std::vector<double> low, high;  ///< bounds, one per parameter; empty: none
  LeastSquaresOptions options;
};

struct CeresEnd {
  bool converged = false;
  int iterations = 0;
  std::string message;
};

}  // namespace bentaxis::designs

/// Levenberg-Marquardt from u on, where the solution is left.
bentaxis::designs::CeresEnd bentaxis_ceres_solve(const bentaxis::designs::CeresTask& task,
                                                 std::vector<double>& u);

extern "C" {
extern decltype(&bentaxis_ceres_solve) const kBentaxisCeres;
}

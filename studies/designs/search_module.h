// The calls into the part of the program that is linked with pagmo.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bentaxis::designs {

/// What pagmo searches: bounds, costs without constraints, whole numbers last.
struct Evolution {
  std::vector<double> low, high;  ///< bounds, one per variable
  std::size_t whole = 0;          ///< so many of the last variables take whole numbers only
  std::size_t objectives = 1;
  std::vector<double> first;  ///< points of the first population, row by row
  unsigned generations = 0, seed = 1;
  /// Costs of points, both row by row. What it throws ends the evolution and reaches the caller.
  std::function<std::vector<double>(const std::vector<double>& points)> costs;
};

}  // namespace bentaxis::designs

extern "C" {

/// NSGA-II for several objectives, GACO for one. Whoever computes costs keeps the points.
void bentaxis_evolve(const bentaxis::designs::Evolution& evolution);

/// Volume that points, all below the reference, dominate; at least two objectives.
double bentaxis_hypervolume(const std::vector<std::vector<double>>& points,
                            const std::vector<double>& reference);
}

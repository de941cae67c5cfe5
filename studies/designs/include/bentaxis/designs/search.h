// Search for the best points of functions of several variables: one objective or several, with
// constraints, whole numbers, and values that are sometimes not there. Knows no pump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bentaxis::designs {

/// What is searched. Costs are to be small; a point is allowed where every constraint is <= 0.
struct SearchProblem {
  std::vector<double> low, high;  ///< bounds, one per variable
  std::vector<bool> whole;        ///< whether only whole numbers are values of it
  std::size_t objectives = 1, constraints = 0;
  /// Costs and constraints of `count` points at once.
  /// @param points   count x variables, row by row
  /// @param results  count x (objectives + constraints): NaN where there is no value. May throw to
  ///                 end the search.
  std::function<void(std::size_t count, std::span<const double> points, std::span<double> results)>
      evaluate;
  /// Exact derivatives, (objectives + constraints) x variables, row by row; false where there are
  /// none at x. Empty: none anywhere.
  std::function<bool(std::span<const double> x, std::span<double> jacobian)> differentiate = {};
  /// Step of differences, as a part of the range of a variable: where there are no derivatives.
  double step = 1e-5;

  std::size_t variables() const { return low.size(); }
  std::size_t numbers() const { return objectives + constraints; }
};

/// How far a point is from being allowed: the sum of the constraints above 0; 0: it is allowed;
/// infinite where it has no values.
double violation(const SearchProblem& problem, std::span<const double> results);

inline constexpr int kMaxPopulation = 100000, kMaxGenerations = 100000, kMaxRestarts = 1000;
struct SearchOptions {
  std::size_t population = 64;   ///< points evaluated at once; a multiple of 4, at least 8
  std::size_t generations = 50;  ///< after the first
  std::size_t restarts = 2;      ///< searches on their own, from other points
  std::uint64_t seed = 1;
  bool refine = true;  ///< improve the best point of each objective by gradients
};

/// An improvement by gradients, from the best point that the search found for one objective; where
/// there is one objective alone, also from other good points of the first populations. Whole
/// numbers stay as they are there.
struct Refinement {
  std::size_t objective = 0;
  double before = 0, after = 0;  ///< its cost, from where to where; NaN where no point is allowed
  std::vector<double> x;         ///< the better of both
  bool exact = false;            ///< by exact derivatives alone
  std::size_t evaluations = 0;
  std::string message;  ///< why it ended
};

struct SearchResult {
  /// Evaluations of each search on its own, and of all refinements, in the order they were made.
  std::vector<std::size_t> evaluations;
  std::vector<Refinement> refinements;  ///< of each objective that has values, the best point first
};

/// Name and version of the libraries; "" where the program was built without them.
std::string search_libraries();

/// Evolutionary search by pagmo, NSGA-II for several objectives and GACO for one, in which every
/// allowed point is better than any that is not and of these the one that violates less (K. Deb, An
/// efficient constraint handling method for genetic algorithms, 2000); then SLSQP of NLopt. All
/// evaluations are made through `problem.evaluate`, whose owner keeps them. The same for the same
/// seed.
/// @param start  points that the first population of each search holds, row by row
/// @throws InputError where bounds or options are impossible, or the libraries are missing;
/// whatever
///         `problem.evaluate` throws
SearchResult search(const SearchProblem& problem, std::span<const double> start,
                    const SearchOptions& options);

/// Points to compare a search with, row by row: independent ones, and a grid that fills the ranges
/// evenly, both ends among them, of at most `count` points and as many values of each variable as
/// that allows.
std::vector<double> random_search_points(const SearchProblem& problem, std::size_t count,
                                         std::uint64_t seed);
std::vector<double> grid_search_points(const SearchProblem& problem, std::size_t count);

/// Volume that points dominate below a reference, of costs: the larger the better the front.
/// @param costs  points x objectives, row by row; points beyond the reference do not count
double hypervolume(std::span<const double> costs, std::span<const double> reference);

}  // namespace bentaxis::designs

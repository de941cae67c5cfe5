// What is not known exactly: distributions of parameters, and correlated points drawn from them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/designs/variable.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::designs {

/// Names as in a case file, in the order of the enumeration.
enum class Shape {
  normal,      ///< mean, standard deviation
  uniform,     ///< low, high
  triangular,  ///< low, most likely, high
  lognormal,   ///< median, standard deviation of the logarithm
};

/// Of a number in the file's unit of its parameter.
struct Distribution {
  Shape shape = Shape::normal;
  std::vector<double> numbers;  ///< as the shape says

  double quantile(double share) const;  ///< share in (0, 1)
  /// The value that is as likely exceeded as `score` is by a standard normal number.
  double at_score(double score) const;
  double cumulative(double value) const;
  double density(double value) const;
  double mean() const;
  double standard_deviation() const;
  std::string text() const;  ///< "normal(40, 0.1)"
};

/// @param text   "normal(40, 0.1)"; where there is a value to be about also "normal(0.1)" and
///               "relative(0.01)", normal about that value with this standard deviation, or this
///               part of it
/// @param what   for messages
/// @throws InputError where the shape is unknown or its numbers are none it can have
Distribution distribution(const std::string& text, const std::string& what,
                          std::optional<double> about = std::nullopt);

/// Variables with their distributions and the correlations of their normal scores (a Gaussian
/// copula): [uncertainty] of a case.
struct UncertainVariables {
  std::vector<Variable> variables;  ///< empty: numbers of some other function
  std::vector<Distribution> distributions;
  std::vector<double> correlation = {};  ///< row by row; empty: independent
  std::vector<double> factor = {};  ///< L of correlation = L L^T, lower triangular, by correlate()

  std::size_t size() const { return distributions.size(); }
  bool independent() const;
  /// Correlates pairs of variables, by their places.
  struct Pair {
    std::size_t first, second;
    double coefficient;  ///< in [-1, 1]
  };
  /// @throws InputError where there are no numbers with these correlations
  void correlate(const std::vector<Pair>& pairs);
  /// Values from independent shares in (0, 1), one per variable.
  void values(std::span<const double> shares, std::span<double> values) const;
  /// Covariances of the values themselves, row by row: of normal numbers the correlation times
  /// both deviations, of others what the correlation of their scores makes of it.
  std::vector<double> covariances() const;
};

/// What the table [uncertainty] of a case says.
/// @throws InputError where it has none, names no number that does something in this case, gives
/// one
///         more than once or values that the registry does not allow, or correlations are
///         impossible
UncertainVariables uncertain_variables(const Case& the_case);

}  // namespace bentaxis::designs

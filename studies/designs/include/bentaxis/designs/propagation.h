// What uncertain numbers do to a function of them: by Monte Carlo, to first order, and by Sobol's
// indices. Knows no pump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/distribution.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::designs {

/// Outputs of `count` points. A point that has none gets its reason. Called by several threads.
/// @param values   count x numbers, row by row
/// @param results  count x outputs, row by row
/// @param reasons  one per point, "" where it has outputs
using Response = std::function<void(std::size_t count, std::span<const double> values,
                                    std::span<double> results, std::span<std::string> reasons)>;

/// A number estimated from samples, and the interval in which it lies with the probability 95 %.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// Order statistics that hold a quantile: of sorted values those numbered `low` and `high` enclose
/// it with a probability of at least 95 %, whatever the values' law (H. A. David, H. N. Nagaraja,
/// Order Statistics, 2003, section 7.1); value lies between them. Made once for many curves.
class QuantileRule {
 public:
  /// @param share in (0, 1) @param samples  at least fewest(share)
  QuantileRule(double share, std::size_t samples);
  /// Fewest samples of which some enclose the quantile.
  static std::size_t fewest(double share);
  Estimate operator()(const std::vector<double>& sorted) const;

 private:
  std::size_t low_, high_, below_;
  double part_;  // of the way from the value `below_` to the next
};

/// What samples of one output say of its law.
struct Spread {
  double mean = 0, mean_error = 0;            ///< and its standard error
  double deviation = 0, deviation_error = 0;  ///< standard deviation, its standard error
  /// Quantiles (1 - level) / 2, 1/2, (1 + level) / 2. not_computed() where the values are too few:
  /// no order statistics enclose the quantile.
  Estimate low, median, high;
};
/// @param values  two at least
/// @param level   in (0, 1): the part of the values between low and high
Spread spread_of(std::vector<double> values, double level);

/// Fewest samples for the quantiles of a level.
std::size_t fewest_samples(double level);
/// Fewest samples for statistics at all.
inline constexpr std::size_t kFewestSamples = 10;
/// Standard error of a standard deviation, as a share of it, by so many samples of a normal law
/// (JCGM 100:2008, E.4.3).
double deviation_known_to(std::size_t samples);

/// Outputs at random points: every point by its number alone.
struct SampledOutputs {
  std::vector<double> results;  ///< of the points that have outputs: points x outputs
  std::size_t outputs = 0;
  /// Reasons of the others, by number of the point, rising.
  std::vector<std::pair<std::size_t, std::string>> infeasible;

  std::vector<double> of(std::size_t output) const;
};
SampledOutputs sample(const Response& response, std::size_t outputs,
                      const UncertainVariables& numbers, std::size_t samples, std::uint64_t seed,
                      int threads = 0, const Progress& progress = {});

/// Law of propagation of uncertainty: JCGM 100:2008 (GUM), 5.1.2 and 5.2.2. Derivatives by central
/// differences over a half and a quarter of each standard deviation, extrapolated.
struct FirstOrder {
  std::vector<double> values;             ///< outputs at the means of all numbers
  std::vector<double> derivatives;        ///< outputs x numbers, row by row
  std::vector<double> derivative_errors;  ///< what the extrapolation changed
  std::vector<double> deviations;         ///< combined standard uncertainty of each output
  std::vector<std::string> reasons;       ///< why a derivative could not be had
};
FirstOrder first_order(const Response& response, std::size_t outputs,
                       const UncertainVariables& numbers);

/// Shares of an output's variance: by one number alone (first), and by it together with others
/// (total). I. M. Sobol', Sensitivity estimates for nonlinear mathematical models, 1993; estimator
/// of J.-M. Martinez, Analyse de sensibilite globale par decomposition de la variance, 2011, with
/// asymptotic intervals: OpenTURNS' MartinezSensitivityAlgorithm.
struct SobolIndices {
  /// outputs x numbers, row by row; values not_computed() where an output does not vary by more
  /// than its round-off. What differs from 0 or 1 by round-off alone is 0 or 1. Every interval
  /// holds its value.
  std::vector<Estimate> first, total;
  std::size_t evaluations = 0;
  std::size_t left_out = 0;  ///< base points, for one of whose points had no outputs
};
inline constexpr std::size_t kFewestBasePoints = 16;  ///< below them there are no intervals
/// @param base  number of base points: (numbers + 2) times as many evaluations
/// @throws InputError where numbers are correlated, or there is no OpenTURNS
SobolIndices sobol_indices(const Response& response, std::size_t outputs,
                           const UncertainVariables& numbers, std::size_t base, std::uint64_t seed,
                           int threads = 0, const Progress& progress = {});

/// @throws InputError where there is no OpenTURNS: before anything is computed, where Sobol indices
/// will be wanted
void require_sobol_indices();

/// Version of the OpenTURNS that this was built with, or "none".
std::string openturns_version();

}  // namespace bentaxis::designs

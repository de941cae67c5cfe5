// What [uncertainty] of a case does to its outputs and to the curves of its reactions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/output.h"
#include "bentaxis/designs/propagation.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// Further numbers of a design, from its analytic or multibody turn.
struct Further {
  std::size_t count = 0;
  std::function<void(const study::PreparedCase&, const ResultTable&, std::span<double>)> of = {};
};

struct UncertaintyOptions {
  std::vector<Output> outputs;
  Further further = {};
  std::size_t samples = 1000;  ///< of the Monte Carlo, at random
  std::uint64_t seed = 1;
  double level = 0.95;      ///< the part of all pumps that a band holds at each angle
  std::size_t sobol = 0;    ///< base points of Sobol indices; 0: none
  bool curves = true;       ///< bands on reactions too
  bool first_order = true;  ///< the law of propagation beside it
  std::size_t most_bytes = std::size_t{512} << 20;  ///< of sampled curves: fewer angles instead
  study::Model model = study::Model::analytic;
  int threads = 0;  ///< 0: one per processor
};

/// A reaction over the turn. Quantiles are those of each angle by itself.
struct CurveBand {
  Channel channel;
  std::vector<double> nominal, low, median, high;  ///< at UncertaintyResult::theta_deg
  std::vector<double> deviation;                   ///< standard deviation
  double peak = 0;                                 ///< of the nominal vector, over the turn
  double widest = 0;                               ///< largest half width of the band
  double edge_error = 0;  ///< largest half width of an edge's interval of 95 %
  double throughout = 0;  ///< part of the sampled curves that leave the band at no angle
};

struct UncertainOutput {
  Output output;
  double nominal = 0;  ///< of the case as it is
  Spread spread;
};

struct UncertaintyResult {
  Case the_case;
  UncertainVariables variables;
  UncertaintyOptions options;
  std::vector<UncertainOutput> outputs;
  FirstOrder first_order;         ///< of the outputs, in their order; empty where not asked for
  SobolIndices sobol;             ///< likewise
  std::vector<double> theta_deg;  ///< of the bands: all or some of the case's
  std::size_t angles = 0;         ///< of the case
  std::vector<CurveBand> bands;   ///< none by too few samples for the quantiles of the level
  std::vector<Spread> further;    ///< of the further numbers
  SampledOutputs sampled;         ///< outputs of all samples, without curves
  /// Where samples were left out: the parameters among those that were not, in their order. Mean
  /// and deviation show how far these are from the stated distributions.
  std::vector<Spread> kept_parameters;
  double seconds = 0;

  std::size_t kept() const { return options.samples - sampled.infeasible.size(); }
  /// What so few samples do not tell, and how many would; "" where they are enough.
  std::string too_few_text() const;
};

/// The reactions of a case of which there is one curve each, of piston 1 where each piston has one:
/// the others' bands are the same, shifted.
std::vector<std::size_t> banded_channels(const Case& the_case);

/// Refuses what has no bands, before anything is computed. @throws InputError
void check_sampling(const Case& the_case, std::size_t samples, double level = 0.95);

/// @throws InputError where the case has no [uncertainty], samples are too few, or an output is not
///         there; ComputationError where most samples have no outputs
UncertaintyResult uncertainty(const Case& the_case, const UncertaintyOptions& asked,
                              const study::PartProgress& progress_of = study::silent());

/// Every number of every output, a line each.
std::string outputs_csv(const UncertaintyResult& result);
/// Bands by angle: theta_deg, then CHANNEL_nominal, _low, _median, _high; "" where there are none.
std::string bands_csv(const UncertaintyResult& result);
/// Values of parameters and outputs of every sample that has some.
std::string samples_csv(const UncertaintyResult& result);

}  // namespace bentaxis::designs

// Splits the difference of two tables into what each differing assumption contributes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"

namespace bentaxis::compare {

/// Contribution of one assumption to one channel, as a curve's summary, channel's unit.
struct Contribution {
  double largest = 0;
  double mean = 0;
};

/// One channel's difference, second minus first, taken apart.
struct ChannelSplit {
  Channel channel;
  bool computed = false;  ///< false where a table lacks the channel
  double peak = 0;
  double largest_difference = 0;
  std::vector<Contribution> contributions;  ///< one per assumption
  double rest = 0;                          ///< largest magnitude of what no assumption explains

  double rest_over_peak() const { return peak > 0 ? rest / peak : (rest > 0 ? 1e300 : 0); }
};

struct Split {
  std::vector<std::string> assumptions;
  std::vector<ChannelSplit> channels;
  double tolerance = 0;  ///< of the rest, over peak

  bool explained() const;
  double largest_rest() const;  ///< over peak, of all channels
};

/// Takes second - first apart along `assumptions` in which they differ.
///
/// `variant(mask)` is the first table's model recomputed with the assumptions of the second taken
/// over for every set bit of `mask`; variant(0) is the first table itself. An assumption's
/// contribution is its effect averaged over every order in which the assumptions can be taken over
/// (Shapley 1953), so contributions add up to variant(all) - first exactly and do not depend on an
/// order. The rest is second - variant(all): what the models disagree about under equal
/// assumptions.
Split split_difference(const ResultTable& first, const ResultTable& second,
                       const std::vector<std::string>& assumptions,
                       const std::function<ResultTable(unsigned mask)>& variant,
                       const ZeroScales& zero_scales, double tolerance);

/// Marks the channels of a comparison that differ and whose rest is within tolerance as explained.
void mark_explained(Comparison& comparison, const Split& split);

}  // namespace bentaxis::compare

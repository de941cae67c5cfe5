#include "bentaxis/compare/split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "bentaxis/pump/number.h"

namespace bentaxis::compare {

bool Split::explained() const {
  return std::all_of(channels.begin(), channels.end(), [&](const ChannelSplit& channel) {
    return !channel.computed || channel.rest_over_peak() <= tolerance;
  });
}

double Split::largest_rest() const {
  double rest = 0;
  for (const ChannelSplit& channel : channels)
    if (channel.computed) rest = std::max(rest, channel.rest_over_peak());
  return rest;
}

void mark_explained(Comparison& comparison, const Split& split) {
  for (ChannelComparison& channel : comparison.channels) {
    if (channel.verdict != Verdict::differs) continue;
    const auto part =
        std::find_if(split.channels.begin(), split.channels.end(),
                     [&](const ChannelSplit& s) { return s.channel.name == channel.channel.name; });
    if (part != split.channels.end() && part->computed && part->rest_over_peak() <= split.tolerance)
      channel.verdict = Verdict::explained;
  }
}

Split split_difference(const ResultTable& first, const ResultTable& second,
                       const std::vector<std::string>& assumptions,
                       const std::function<ResultTable(unsigned mask)>& variant,
                       const ZeroScales& zero_scales, double tolerance) {
  const auto count = static_cast<unsigned>(assumptions.size());
  const unsigned all = (1U << count) - 1;
  std::vector<ResultTable> variants{first};
  for (unsigned mask = 1; mask <= all; ++mask) variants.push_back(variant(mask));

  // Weight of a step from a set of `size` assumptions in the average over all orders.
  const auto factorial = [](unsigned n) { return std::tgamma(n + 1.0); };
  const auto weight = [&](unsigned size) {
    return factorial(size) * factorial(count - size - 1) / factorial(count);
  };

  Split split;
  split.assumptions = assumptions;
  split.tolerance = tolerance;
  for (std::size_t column = 0; column < first.columns(); ++column) {
    ChannelSplit result;
    result.channel = first.channels[column];
    if (result.channel.kind == ChannelKind::check || result.channel.kind == ChannelKind::input)
      continue;
    result.peak = scale_of(first, result.channel, zero_scales);
    result.contributions.resize(count);
    const std::size_t other = second.find(result.channel.name);
    result.computed = other < second.columns();
    for (std::size_t row = 0; row < first.rows() && result.computed; ++row) {
      const double end = variants[all].at(row, column);
      const double target = second.at(row, other);
      const double start = first.at(row, column);
      if (!is_computed(target) || !is_computed(start)) {
        result.computed = !is_computed(target) && !is_computed(start);
        continue;
      }
      if (!is_computed(end)) {  // nothing says what equal assumptions give: not explained
        result.rest = std::numeric_limits<double>::infinity();
        continue;
      }
      result.largest_difference = std::max(result.largest_difference, std::abs(target - start));
      result.rest = std::max(result.rest, std::abs(target - end));
      for (unsigned i = 0; i < count; ++i) {
        double part = 0;
        for (unsigned mask = 0; mask <= all; ++mask) {
          if ((mask & (1U << i)) != 0) continue;
          const double step =
              variants[mask | (1U << i)].at(row, column) - variants[mask].at(row, column);
          if (is_computed(step)) part += weight(static_cast<unsigned>(std::popcount(mask))) * step;
        }
        result.contributions[i].largest = std::max(result.contributions[i].largest, std::abs(part));
        result.contributions[i].mean += part / static_cast<double>(first.rows());
      }
    }
    split.channels.push_back(std::move(result));
  }
  return split;
}

}  // namespace bentaxis::compare

#include "bentaxis/study/rounding_spread.h"

#include <limits>
#include <random>

#include "bentaxis/pump/inputs.h"
#include "bentaxis/results/max_abs.h"

namespace bentaxis::study {
namespace {

constexpr int kDraws = 4;

// A case with every input of its pump moved by one unit in the last place, up or down.
Case moved(const Case& the_case, std::mt19937& engine) {
  Case copy = the_case;
  for (const PumpInput& input : continuous_inputs(copy.pump)) {
    const double sign = (engine() & 1U) != 0 ? 1 : -1;
    const double value = *input.value * (1 + sign * std::numeric_limits<double>::epsilon());
    if (input.range.contains(value)) *input.value = value;  // a share stays a share
  }
  return copy;
}

}  // namespace

std::map<std::string, double> largest_of_groups(const compare::Comparison& comparison) {
  std::map<std::string, double> groups;
  for (const auto& c : comparison.channels)
    if (c.channel.kind == ChannelKind::reaction) groups[c.channel.group] = 0;
  for (auto& [group, largest] : groups)
    if (const auto* const found = comparison.furthest([&, name = group](const Channel& channel) {
          return channel.kind == ChannelKind::reaction && channel.group == name;
        }))
      largest = found->largest_over_peak();
  return groups;
}

std::map<std::string, double> rounding_spread(const Case& the_case, const ResultTable& table,
                                              const compare::Options& options,
                                              const std::function<ResultTable(const Case&)>& run) {
  std::mt19937 engine(1);
  std::map<std::string, double> spread;
  std::string refusal;
  for (int draw = 0; draw < kDraws; ++draw) {
    try {
      const auto comparison = compare::compare_tables(table, run(moved(the_case, engine)), options);
      for (const auto& [group, change] : largest_of_groups(comparison))
        update_max_abs(spread[group], change);
    } catch (const ComputationError& error) {
      refusal = error.what();
    } catch (const InputError& error) {
      // This copy is no pump any more: it lay on a bound between two inputs.
      refusal = error.what();
    }
  }
  if (spread.empty())
    throw NoEstimate(
        "the effect of rounding could not be estimated: all " + std::to_string(kDraws) +
        " copies with inputs moved by one unit in the last place were refused (" + refusal + ")");
  return spread;
}

}  // namespace bentaxis::study

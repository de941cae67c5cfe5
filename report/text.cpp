#include "bentaxis/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "bentaxis/compare/stated_difference.h"

namespace bentaxis::report {

std::string text_table(const compare::Comparison& comparison) {
  // Worst channel of each group; a gap is worse than any difference.
  const auto rank = [](const compare::ChannelComparison* c) {
    if (c->verdict == compare::Verdict::incomplete) return std::numeric_limits<double>::infinity();
    return c->compared() ? c->largest_over_peak() : -1.0;
  };
  std::map<std::string, const compare::ChannelComparison*> worst;
  for (const compare::ChannelComparison& c : comparison.channels) {
    if (!c.judged) continue;
    // What this pump does not have is no gap where neither model gives it.
    if (!c.channel.of_pump && !c.compared() && c.gap.empty()) continue;
    auto& entry = worst[c.channel.group];
    if (entry == nullptr || rank(&c) > rank(entry)) entry = &c;
  }
  std::vector<const compare::ChannelComparison*> rows;
  for (const auto& [group, c] : worst) rows.push_back(c);
  std::ranges::stable_sort(rows, [&](const auto* a, const auto* b) { return rank(a) > rank(b); });
  std::string text = fmt::format("{:<16} {:>12} {:>4}  {:>12} {:>10} {:>7}  {}\n", "worst channel",
                                 "vector peak", "", "difference", "over peak", "digits", "verdict");
  for (const auto* c : rows) {
    if (!c->compared())
      text += fmt::format("{:<16} {:>12.5g} {:>4}  {:>12} {:>10} {:>7}  {}\n", c->channel.name,
                          c->peak, c->channel.unit, "", "", "",
                          c->gap.empty() ? "not computed by both" : "incomplete: " + c->gap);
    else
      text += fmt::format(
          "{:<16} {:>12.5g} {:>4}  {:>12.2e} {:>10.1e} {:>7.1f}  {}\n", c->channel.name, c->peak,
          c->channel.unit, c->largest, c->largest_over_peak(), c->digits,
          std::string(compare::to_string(c->verdict)) +
              (compare::is_nearest_to_limit(*c) ? ", difference nearest to its limit" : ""));
  }
  return text;
}

}  // namespace bentaxis::report

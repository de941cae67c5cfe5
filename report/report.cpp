#include "bentaxis/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace bentaxis::report {

Json channel_rows(const compare::Comparison& comparison) {
  Document part;
  part.comparison = comparison;
  return to_json(part)["channels"];
}

Json check_rows(const std::vector<compare::Check>& checks) {
  Document part;
  part.checks = checks;
  return to_json(part)["checks"];
}

Json split_section(const compare::Split& split, const std::vector<AssumptionRow>& rows,
                   const std::string& text) {
  Document part;
  part.assumptions = {text, rows, split};
  return to_json(part)["assumptions"];
}

Json published_section(const PublishedTable& published) {
  Document part;
  part.published = published;
  return to_json(part)["published"];
}

Json model_section(const ResultTable& table, const Lines& assumptions) {
  Document part;
  part.models = {model_of(table, assumptions)};
  return to_json(part)["models"][0];
}

Json curve_section(const ResultTable& first, const ResultTable& second) {
  return to_json(curves_of(first, second));
}

Json plot_values(const Values& values, double unit_in_si) {
  Values scaled;
  for (const double value : values) scaled.push_back(value / unit_in_si);
  return to_json(Curves{{}, {{"", {{"", scaled}}}}, {}})["tables"][0]["columns"][""];
}

Json curve(const ResultTable& table, const std::string& channel_name) {
  return plot_values(values_of(table, channel_name));
}

std::string text_table(const compare::Comparison& comparison) {
  // Worst channel of each group; a gap is worse than any difference.
  const auto rank = [](const compare::ChannelComparison* c) {
    if (c->verdict == compare::Verdict::incomplete) return std::numeric_limits<double>::infinity();
    return c->compared() ? c->largest_over_peak() : -1.0;
  };
  std::map<std::string, const compare::ChannelComparison*> worst;
  for (const compare::ChannelComparison& c : comparison.channels) {
    if (!c.judged) continue;
    auto& entry = worst[c.channel.group];
    if (entry == nullptr || rank(&c) > rank(entry)) entry = &c;
  }
  std::vector<const compare::ChannelComparison*> rows;
  for (const auto& [group, c] : worst) rows.push_back(c);
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const auto* a, const auto* b) { return rank(a) > rank(b); });
  std::string text = fmt::format("{:<16} {:>12} {:>4}  {:>12} {:>10} {:>7}  {}\n", "worst channel",
                                 "peak", "", "difference", "over peak", "digits", "verdict");
  for (const auto* c : rows) {
    if (!c->compared())
      text += fmt::format("{:<16} {:>12.5g} {:>4}  {:>12} {:>10} {:>7}  {}\n", c->channel.name,
                          c->peak, c->channel.unit, "", "", "",
                          c->gap.empty() ? "not computed by both" : "incomplete: " + c->gap);
    else
      text += fmt::format("{:<16} {:>12.5g} {:>4}  {:>12.2e} {:>10.1e} {:>7.1f}  {}\n",
                          c->channel.name, c->peak, c->channel.unit, c->largest,
                          c->largest_over_peak(), c->digits, compare::to_string(c->verdict));
  }
  return text;
}

}  // namespace bentaxis::report

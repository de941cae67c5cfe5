#include "bentaxis/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bentaxis/pump/number.h"

namespace bentaxis::report {
namespace {

const char* to_string(ChannelKind kind) {
  switch (kind) {
    case ChannelKind::reaction:
      return "reaction";
    case ChannelKind::derived:
      return "derived";
    case ChannelKind::input:
      return "input";
    case ChannelKind::check:
      break;
  }
  return "check";
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json rounded(double value) {
  if (!is_computed(value)) return nullptr;
  return std::strtod(fmt::format("{:.9g}", value).c_str(), nullptr);
}

Json column(const ResultTable& table, std::size_t index) {
  Json values = Json::array();
  for (std::size_t row = 0; row < table.rows(); ++row)
    values.push_back(rounded(table.at(row, index)));
  return values;
}

}  // namespace

Json channel_rows(const compare::Comparison& comparison) {
  Json rows = Json::array();
  for (const compare::ChannelComparison& c : comparison.channels) {
    const Channel& channel = c.channel;
    Json row = {{"name", channel.name},
                {"quantity", channel.quantity},
                {"meaning", channel.meaning},
                {"equation", channel.equation},
                {"piston", channel.piston},
                {"axis", channel.axis},
                {"frame", channel.frame},
                {"on_body", channel.on_body},
                {"by_body", channel.by_body},
                {"point", channel.point},
                {"unit", channel.unit},
                {"group", channel.group},
                {"kind", to_string(channel.kind)},
                {"compared", c.judged},
                {"peak", c.peak},
                {"verdict", compare::to_string(c.verdict)},
                {"tolerance", c.tolerance}};
    if (c.verdict != compare::Verdict::not_computed) {
      row["max_abs"] = c.largest;
      row["max_over_peak"] = number_or_null(c.largest_over_peak());
      row["rms"] = c.rms;
      row["rms_over_peak"] = number_or_null(c.rms_over_peak());
      row["theta_of_max_deg"] = c.theta_of_largest_deg;
      row["mean"] = {c.mean[0], c.mean[1]};
      row["mean_difference"] = c.mean_difference;
      row["digits"] = c.digits;
      row["orders"] = Json::array();
      for (const compare::Harmonic& harmonic : c.harmonics) {
        Json phases = Json::array();
        for (const auto& phase : harmonic.phase_deg)
          phases.push_back(phase ? Json(*phase) : Json());
        row["orders"].push_back({{"order", harmonic.order},
                                 {"amplitude", {harmonic.amplitude[0], harmonic.amplitude[1]}},
                                 {"phase_deg", phases}});
      }
    } else {
      for (const char* key : {"max_abs", "max_over_peak", "rms", "rms_over_peak",
                              "theta_of_max_deg", "mean_difference", "digits"})
        row[key] = nullptr;
      row["mean"] = {nullptr, nullptr};
      row["orders"] = Json::array();
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json check_rows(const std::vector<compare::Check>& checks) {
  Json rows = Json::array();
  for (const compare::Check& check : checks)
    rows.push_back({{"model", check.table},
                    {"name", check.name},
                    {"worst", check.worst},
                    {"unit", check.unit},
                    {"scale", check.scale},
                    {"relative", check.relative()},
                    {"tolerance", check.tolerance},
                    {"theta_deg", check.theta_deg},
                    {"verdict", check.holds() ? "holds" : "violated"}});
  return rows;
}

Json split_section(const compare::Split& split, const std::vector<AssumptionRow>& rows,
                   const std::string& text) {
  Json section = {{"text", text}, {"rows", Json::array()}, {"channels", Json::array()}};
  for (const auto& row : rows)
    section["rows"].push_back(
        {{"name", row.name}, {"analytic", row.first}, {"multibody", row.second}});
  for (const compare::ChannelSplit& channel : split.channels) {
    if (!channel.computed) continue;
    const auto over_peak = [&](double value) {
      return channel.peak > 0 ? value / channel.peak : 0;
    };
    Json parts = Json::array();
    for (std::size_t i = 0; i < split.assumptions.size(); ++i)
      parts.push_back({{"assumption", split.assumptions[i]},
                       {"max_abs", channel.contributions[i].largest},
                       {"over_peak", over_peak(channel.contributions[i].largest)},
                       {"mean", channel.contributions[i].mean}});
    section["channels"].push_back(
        {{"name", channel.channel.name},
         {"group", channel.channel.group},
         {"kind", to_string(channel.channel.kind)},
         {"unit", channel.channel.unit},
         {"peak", channel.peak},
         {"max_abs", channel.largest_difference},
         {"over_peak", over_peak(channel.largest_difference)},
         {"contributions", parts},
         {"rest", channel.rest},
         {"rest_over_peak", channel.rest_over_peak()},
         {"verdict", channel.rest_over_peak() <= split.tolerance ? "explained" : "unexplained"}});
  }
  return section;
}

Json model_section(const ResultTable& table, const Lines& assumptions) {
  return {{"name", table.name},
          {"assumptions", assumptions},
          {"facts", table.provenance.facts},
          {"seconds", table.provenance.seconds},
          {"angles", table.rows()}};
}

Json curve_section(const ResultTable& first, const ResultTable& second) {
  Json section = {{"theta_deg", first.theta_deg}, {"difference", Json::object()}};
  for (const ResultTable* table : {&first, &second}) {
    Json columns = Json::object();
    for (std::size_t c = 0; c < table->columns(); ++c)
      if (table->channels[c].kind != ChannelKind::check)
        columns[table->channels[c].name] = column(*table, c);
    section["tables"].push_back({{"name", table->name}, {"columns", columns}});
  }
  for (std::size_t a = 0; a < first.columns(); ++a) {
    const std::size_t b = second.find(first.channels[a].name);
    const ChannelKind kind = first.channels[a].kind;
    if (b == second.columns() || kind == ChannelKind::check || kind == ChannelKind::input) continue;
    Json values = Json::array();
    for (std::size_t row = 0; row < first.rows(); ++row) {
      const double difference = second.at(row, b) - first.at(row, a);
      values.push_back(is_computed(difference)
                           ? Json(std::strtod(fmt::format("{:.4g}", difference).c_str(), nullptr))
                           : Json());
    }
    section["difference"][first.channels[a].name] = std::move(values);
  }
  return section;
}

Json curve(const ResultTable& table, const std::string& channel_name) {
  return column(table, table.find(channel_name));
}

std::string text_table(const compare::Comparison& comparison) {
  // Worst channel of each group.
  std::map<std::string, const compare::ChannelComparison*> worst;
  for (const compare::ChannelComparison& c : comparison.channels) {
    if (!c.judged) continue;
    auto& entry = worst[c.channel.group];
    if (entry == nullptr || (c.verdict != compare::Verdict::not_computed &&
                             c.largest_over_peak() > entry->largest_over_peak()))
      entry = &c;
  }
  std::vector<const compare::ChannelComparison*> rows;
  for (const auto& [group, c] : worst) rows.push_back(c);
  std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) {
    const auto rank = [](const compare::ChannelComparison* c) {
      return c->verdict == compare::Verdict::not_computed ? -1.0 : c->largest_over_peak();
    };
    return rank(a) > rank(b);
  });
  std::string text = fmt::format("{:<16} {:>12} {:>4}  {:>12} {:>10} {:>7}  {}\n", "worst channel",
                                 "peak", "", "difference", "over peak", "digits", "verdict");
  for (const auto* c : rows) {
    if (c->verdict == compare::Verdict::not_computed)
      text += fmt::format("{:<16} {:>12.5g} {:>4}  {:>12} {:>10} {:>7}  {}\n", c->channel.name,
                          c->peak, c->channel.unit, "", "", "", "not computed by both");
    else
      text += fmt::format("{:<16} {:>12.5g} {:>4}  {:>12.2e} {:>10.1e} {:>7.1f}  {}\n",
                          c->channel.name, c->peak, c->channel.unit, c->largest,
                          c->largest_over_peak(), c->digits, compare::to_string(c->verdict));
  }
  return text;
}

}  // namespace bentaxis::report

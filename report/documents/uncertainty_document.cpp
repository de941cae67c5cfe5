#include "bentaxis/designs/uncertainty_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/pump/fixed_text.h"
#include "bentaxis/pump/number.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

using report::Cell;
using report::Section;

std::string percent(double share) { return fmt::format("{:g} %", 100 * share); }

// "292.51 Nm, 95 % in 290.1 .. 294.9"
std::string in_words(const UncertainOutput& o, double level) {
  const Spread& s = o.spread;
  return fmt::format(
      "{} = {:.6g} {}: {} of the pumps in {:.6g} .. {:.6g}, standard uncertainty {:.3g}",
      o.output.name, o.nominal, o.output.unit, percent(level), s.low.value, s.high.value,
      s.deviation);
}

// "12 of 300 samples (4 %) are no pump .. and are left out"
std::string left_out_text(const UncertaintyResult& result) {
  const std::size_t without = result.sampled.infeasible.size(), all = result.options.samples;
  return fmt::format(
      "{} of {} samples are infeasible pumps and are left out ({:.3g} %): all statistics are those "
      "of the other samples alone, and their deviation is not that of the stated distributions",
      without, all, 100 * static_cast<double>(without) / static_cast<double>(all));
}

std::string headline(const UncertaintyResult& result) {
  std::string text = result.outputs.empty()
                         ? std::string("bands on reactions")
                         : in_words(result.outputs.front(), result.options.level);
  if (!result.sampled.infeasible.empty()) text += "; " + left_out_text(result);
  return text;
}

// Two significant digits, also of 100 %: never in powers of ten.
std::string percent_text(double share) {
  return std::abs(share) >= 0.0995 ? fmt::format("{:.0f} %", 100 * share)
                                   : fmt::format("{:.2g} %", 100 * share);
}

// The parameters that make most of an output's variance, to first order: "pump.tilt_deg 78 %".
std::string largest_shares(const UncertaintyResult& result, std::size_t o) {
  constexpr std::size_t kNamed = 2;
  const std::size_t n = result.variables.size();
  std::vector<std::pair<double, std::size_t>> squares;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double part = result.first_order.derivatives[o * n + i] *
                        result.variables.distributions[i].standard_deviation();
    if (!is_computed(part)) return "";
    squares.emplace_back(part * part, i);
    sum += part * part;
  }
  if (!(sum > 0) || !result.variables.independent()) return "";
  std::stable_sort(squares.begin(), squares.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, n); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ",
                        result.variables.variables[squares[i].second].name(),
                        percent_text(squares[i].first / sum));
  return text;
}

// What each output may be, and what makes most of it.
std::vector<std::string> answers_of(const UncertaintyResult& result) {
  std::vector<std::string> answers;
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    std::string text = in_words(result.outputs[o], result.options.level);
    if (result.options.first_order)
      if (const std::string shares = largest_shares(result, o); !shares.empty())
        text += "; of its variance " + shares;
    answers.push_back(text + ".");
  }
  return answers;
}

// To the digits that its interval leaves: two more than the interval has.
std::string digits(double value, double interval) {
  if (!(interval > 0) || value == 0) return fmt::format("{:.6g}", value);
  const double size = std::max(std::abs(value), interval);
  const int count = static_cast<int>(std::ceil(std::log10(size / interval))) + 2;
  // No fewer than stand before the point, up to a million: 16190 rather than 1.619e+04.
  const int whole = size < 1e6 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 0;
  return fmt::format("{:.{}g}", value, std::clamp(std::max(count, whole), 2, 15));
}
std::string with_error(double value, double error) {
  return digits(value, error) + fmt::format(" +- {:g}", rounded(error, 2));
}
std::string with_interval(const Estimate& e) {
  const double width = e.high - e.low;
  return digits(e.value, width) + " (" + digits(e.low, width) + " .. " + digits(e.high, width) +
         ")";
}

Section outputs_section(const UncertaintyResult& result) {
  const double tail = (1 - result.options.level) / 2;
  Section section{
      "Outputs",
      fmt::format(
          "Monte Carlo: {} independent samples, random numbers of seed {}. In brackets the "
          "interval that holds the quantile with 95 % probability, by order statistics; behind +- "
          "the standard error. Nominal: the case as it is. All digits are in outputs.csv.",
          result.options.samples, result.options.seed),
      {},
      {{"output", "unit", "nominal", "mean", "standard deviation", percent(tail) + " quantile",
        "median", percent(1 - tail) + " quantile"},
       {}}};
  for (const UncertainOutput& o : result.outputs) {
    const Spread& s = o.spread;
    section.table.rows.push_back({o.output.name, o.output.unit, digits(o.nominal, s.mean_error),
                                  with_error(s.mean, s.mean_error),
                                  with_error(s.deviation, s.deviation_error), with_interval(s.low),
                                  with_interval(s.median), with_interval(s.high)});
  }
  return section;
}

Section first_order_section(const UncertaintyResult& result) {
  Section section{
      "First order beside it",
      "Law of propagation of uncertainty (JCGM 100, 5.1 and 5.2): value at the parameters' means, "
      "combined standard uncertainty from derivatives there and covariances. Where it differs from "
      "Monte Carlo by more than the latter's standard error, the output is not linear over the "
      "range of uncertainty; Monte Carlo is then valid.",
      result.sampled.infeasible.empty()
          ? report::Lines{}
          : report::
                Lines{{"left-out samples",
                       "First order takes the stated distributions as a whole, Monte Carlo only "
                       "the samples that are pumps: the two differ by that too."}},
      {{"output", "unit", "value at the means", "combined standard uncertainty", "of Monte Carlo",
        "standard error of that"},
       {}}};
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    const UncertainOutput& output = result.outputs[o];
    section.table.rows.push_back({output.output.name, output.output.unit,
                                  result.first_order.values[o], result.first_order.deviations[o],
                                  output.spread.deviation, output.spread.deviation_error});
  }
  for (const std::string& reason : result.first_order.reasons)
    section.facts.emplace_back("no derivative", reason);
  return section;
}

Section contributions_section(const UncertaintyResult& result) {
  Section section{
      "Contributions of the parameters, to first order",
      "Derivative by differences over half and a quarter of the standard deviation, "
      "extrapolated; its error is what the extrapolation changed. Contribution: "
      "derivative x standard deviation of the parameter.",
      {},
      {{"output", "parameter", "derivative", "error of it", "unit of it", "contribution", "unit"},
       {}}};
  const std::size_t n = result.variables.size();
  for (std::size_t o = 0; o < result.outputs.size(); ++o)
    for (std::size_t i = 0; i < n; ++i) {
      const Variable& v = result.variables.variables[i];
      const Output& output = result.outputs[o].output;
      const double derivative = result.first_order.derivatives[o * n + i];
      const std::string of = output.unit.empty() ? "1" : output.unit;
      section.table.rows.push_back(
          {output.name, v.name(), derivative, result.first_order.derivative_errors[o * n + i],
           v.unit().empty() ? of : of + "/" + v.unit(),
           derivative * result.variables.distributions[i].standard_deviation(), output.unit});
    }
  return section;
}

std::string share_text(double share) { return fixed_text(share, 3); }
std::string share_text(const Estimate& e) {
  return share_text(e.value) + " (" + share_text(e.low) + " .. " + share_text(e.high) + ")";
}

std::string sobol_left_out_text(const UncertaintyResult& result) {
  const std::size_t without = result.sobol.left_out;
  if (without == 0) return "0";
  return fmt::format(
      "{} of {} ({:.3g} %), one of whose points is infeasible: the indices are those of the other "
      "points alone, among which the parameters are no longer independent",
      without, result.options.sobol,
      100 * static_cast<double>(without) / static_cast<double>(result.options.sobol));
}

Section sobol_section(const UncertaintyResult& result) {
  Section section{
      "Sobol indices",
      "Shares of the output's variance: first, by the parameter alone; total, by it together with "
      "others. Martinez' estimator (OpenTURNS), with the interval of 95 % that it has at "
      "independent points; the points are a Sobol sequence, so that it errs on the safe side.",
      {{"evaluations", std::to_string(result.sobol.evaluations)},
       {"base points left out", sobol_left_out_text(result)}},
      {{"output", "parameter", "first", "from", "to", "total", "from", "to"}, {}}};
  const std::size_t n = result.variables.size();
  for (std::size_t o = 0; o < result.outputs.size(); ++o)
    for (std::size_t i = 0; i < n; ++i) {
      const Estimate &first = result.sobol.first[o * n + i], &total = result.sobol.total[o * n + i];
      section.table.rows.push_back({result.outputs[o].output.name,
                                    result.variables.variables[i].name(), first.value, first.low,
                                    first.high, total.value, total.low, total.high});
    }
  return section;
}

report::Figure contributions_figure(const UncertaintyResult& result, std::size_t o) {
  const std::size_t n = result.variables.size();
  const Output& output = result.outputs[o].output;
  std::vector<std::pair<double, std::size_t>> sizes;
  const auto of = [&](std::size_t i) {
    return result.first_order.derivatives[o * n + i] *
           result.variables.distributions[i].standard_deviation();
  };
  for (std::size_t i = 0; i < n; ++i)
    if (is_computed(of(i))) sizes.emplace_back(-std::abs(of(i)), i);
  std::sort(sizes.begin(), sizes.end());
  report::BarsFigure bars{{"contribution to " + output.name, output.unit}, {}};
  constexpr double kDrawn = 1e-6;  // of the largest: the rest may be round-off
  for (const auto& [size, i] : sizes)
    if (size < kDrawn * sizes.front().first)
      bars.bars.push_back({result.variables.variables[i].name(), size, -size,
                           result.variables.distributions[i].text() + ": " +
                               fmt::format("{:+.3g} {}", of(i), output.unit)});
  return {fmt::format("contributions_{}", o + 1),
          output.name + ": contributions to its uncertainty", "", bars,
          "One standard deviation of each parameter, to first order; longest first."};
}

report::Figure sobol_figure(const UncertaintyResult& result, std::size_t o) {
  const std::size_t n = result.variables.size();
  report::BarsFigure bars{{"share of the variance of " + result.outputs[o].output.name, ""}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    const std::string name = result.variables.variables[i].name();
    const auto add = [&](const char* what, const Estimate& e) {
      if (is_computed(e.value))
        bars.bars.push_back({name + ", " + what, 0, e.value, "", std::pair(e.low, e.high)});
    };
    add("first", result.sobol.first[o * n + i]);
    add("total", result.sobol.total[o * n + i]);
  }
  return {fmt::format("sobol_{}", o + 1), result.outputs[o].output.name + ": Sobol indices", "",
          bars, "With intervals of 95 %."};
}

}  // namespace

Section parameters_section(const UncertaintyResult& result) {
  Section section{"What is not known",
                  "",
                  {},
                  {{"parameter", "unit", "in the case", "distribution", "mean",
                    "standard deviation", "over the mean, %"},
                   {}}};
  const UncertainVariables& all = result.variables;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Distribution& d = all.distributions[i];
    const double mean = d.mean(), deviation = d.standard_deviation();
    section.table.rows.push_back(
        {all.variables[i].name(), all.variables[i].unit(), all.variables[i].value(result.the_case),
         d.text(), mean, deviation, mean != 0 ? Cell(100 * deviation / std::abs(mean)) : Cell()});
  }
  for (const UncertaintyData::Correlation& c : result.the_case.uncertainty.correlations)
    section.facts.emplace_back("correlation of " + c.first + " and " + c.second,
                               number_text(c.coefficient));
  return section;
}

void add_left_out(report::Document& document, const UncertaintyResult& result) {
  if (result.sampled.infeasible.empty()) return;
  report::append(document.warnings, report::Warning{"Samples left out", left_out_text(result)});
  std::map<std::string, long> counts;
  for (const auto& [index, reason] : result.sampled.infeasible) ++counts[reason];
  const auto without = static_cast<double>(result.sampled.infeasible.size());
  Section reasons{
      "Samples that are no pump",
      "Left out of all results above: these apply to the feasible pumps.",
      {{"samples",
        fmt::format("{} of {}", result.sampled.infeasible.size(), result.options.samples)},
       {"share, %",
        fmt::format("{:.3g}", 100 * without / static_cast<double>(result.options.samples))}},
      {{"reason", "samples"}, {}}};
  constexpr std::size_t kMax = 20;
  for (const auto& [reason, count] : counts)
    if (reasons.table.rows.size() < kMax) reasons.table.rows.push_back({reason, count});
  if (counts.size() > kMax)
    reasons.facts.emplace_back("reasons not listed", std::to_string(counts.size() - kMax));
  report::append(document.runs, std::move(reasons));

  Section kept{
      "Parameters of the remaining samples",
      "Leaving samples out changes the distributions of the parameters: where mean or "
      "standard deviation of the samples that are left differ from the stated ones by more "
      "than their standard errors, mean, standard deviation and quantiles of the outputs "
      "are those of these narrower distributions, not of the stated ones.",
      {},
      {{"parameter", "unit", "stated mean", "mean", "standard error of it",
        "stated standard deviation", "standard deviation", "standard error of it"},
       {}}};
  for (std::size_t i = 0; i < result.kept_parameters.size(); ++i) {
    const Spread& s = result.kept_parameters[i];
    const Distribution& d = result.variables.distributions[i];
    kept.table.rows.push_back({result.variables.variables[i].name(),
                               result.variables.variables[i].unit(), d.mean(), s.mean, s.mean_error,
                               d.standard_deviation(), s.deviation, s.deviation_error});
  }
  document.runs->push_back(std::move(kept));
}

Section bands_section(const UncertaintyResult& result) {
  const double level = result.options.level;
  Section section{
      "Bands on reactions",
      fmt::format("Pointwise quantiles of {} samples: at each angle {} of the pumps are inside. "
                  "Fewer are inside throughout the turn: the table gives this share. An edge is "
                  "known within its interval of 95 %, by order statistics.",
                  result.options.samples - result.sampled.infeasible.size(), percent(level)),
      {},
      {{"channel", "unit", "peak of the vector", "largest half width", "of peak, %",
        "largest half interval of an edge", "of peak, %", "within throughout, %"},
       {}}};
  for (const CurveBand& b : result.bands) {
    const auto of_peak = [&](double value) {
      return b.peak > 0 ? Cell(100 * value / b.peak) : Cell();
    };
    section.table.rows.push_back({b.channel.name, b.channel.unit, b.peak, b.widest,
                                  of_peak(b.widest), b.edge_error, of_peak(b.edge_error),
                                  100 * b.throughout});
  }
  if (result.theta_deg.size() < result.angles)
    section.facts.emplace_back("angles", fmt::format("{} of the case's {}, to fit into memory",
                                                     result.theta_deg.size(), result.angles));
  return section;
}

std::vector<report::Figure> band_figures(const UncertaintyResult& result) {
  std::vector<report::Figure> figures;
  std::string last;
  for (const CurveBand& band : result.bands) {
    const Channel& c = band.channel;
    if (c.group != last) {
      const std::string of = c.piston > 0 ? " of piston 1" : "";
      figures.push_back({"band_" + c.group, c.group + of + ": " + c.meaning, "",
                         report::BandFigure{
                             {"shaft angle", "deg"}, {c.group, c.unit}, true, result.theta_deg, {}},
                         fmt::format("Median and band of {}; dashed: the case as it is.",
                                     percent(result.options.level))});
      last = c.group;
    }
    auto& figure = std::get<report::BandFigure>(figures.back().content);
    figure.bands.push_back({c.name, band.low, band.median, band.high});
    figure.lines.push_back({c.name + ", nominal", result.theta_deg, band.nominal});
  }
  return figures;
}

report::Document uncertainty_document(const UncertaintyResult& result, const report::Lines& program,
                                      const study::CaseDescription& description) {
  report::Document document =
      study::case_document(description, result.the_case.name + ": uncertain parameters", program);
  document.verdict = report::Verdict{std::nullopt, headline(result), "Uncertainty"};
  document.verdict->answers = answers_of(result);
  document.meaning = "Effect of the stated distributions of parameters on the results of the " +
                     study::to_string(result.options.model) +
                     " model. Effects that the model leaves out and parameters without a "
                     "distribution are not included.";
  document.runs.emplace();
  document.runs->push_back(parameters_section(result));
  document.figures.emplace();
  if (!result.outputs.empty()) {
    document.runs->push_back(outputs_section(result));
    if (result.options.first_order) {
      document.runs->push_back(first_order_section(result));
      document.runs->push_back(contributions_section(result));
      for (std::size_t o = 0; o < result.outputs.size(); ++o)
        document.figures->push_back(contributions_figure(result, o));
    }
    if (result.options.sobol > 0) {
      document.runs->push_back(sobol_section(result));
      for (std::size_t o = 0; o < result.outputs.size(); ++o)
        document.figures->push_back(sobol_figure(result, o));
    }
  }
  if (!result.bands.empty()) {
    document.runs->push_back(bands_section(result));
    append(document.figures, band_figures(result));
  }
  add_left_out(document, result);
  return document;
}

std::string uncertainty_text(const UncertaintyResult& result) {
  std::string text = result.the_case.name + "\n";
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    text += in_words(result.outputs[o], result.options.level);
    if (result.options.first_order) {
      text += fmt::format(", to first order {:.3g}", result.first_order.deviations[o]);
      if (const std::string shares = largest_shares(result, o); !shares.empty())
        text += "; of its variance " + shares;
    }
    text += "\n";
  }
  const std::size_t n = result.variables.size();
  if (result.options.sobol > 0)
    for (std::size_t o = 0; o < result.outputs.size(); ++o)
      for (std::size_t i = 0; i < n; ++i) {
        const Estimate &first = result.sobol.first[o * n + i],
                       &total = result.sobol.total[o * n + i];
        text += result.outputs[o].output.name + ": " + result.variables.variables[i].name() + ": ";
        text += is_computed(first.value)
                    ? "first " + share_text(first) + ", total " + share_text(total) + "\n"
                    : "no indices, the output does not vary\n";
      }
  const CurveBand* widest = nullptr;
  for (const CurveBand& b : result.bands)
    if (b.peak > 0 && (widest == nullptr || b.widest / b.peak > widest->widest / widest->peak))
      widest = &b;
  if (widest != nullptr)
    text += fmt::format("widest band: {}, +-{:.3g} {}, {} of peak\n", widest->channel.name,
                        widest->widest, widest->channel.unit,
                        percent_text(widest->widest / widest->peak));
  if (!result.sampled.infeasible.empty())
    text += left_out_text(result) +
            "; the first reason: " + result.sampled.infeasible.front().second + "\n";
  return text;
}

}  // namespace bentaxis::designs

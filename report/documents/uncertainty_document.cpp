#include "bentaxis/designs/uncertainty_document.h"

#include <map>

#include "bentaxis/pump/fixed_text.h"
#include "bentaxis/pump/number.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

using report::NewSection;
using report::Section;

std::string percent(double share) { return fmt::format("{:g} %", 100 * share); }

// "292.51 Nm: 95 % of the pumps in 290.1 .. 294.9, standard uncertainty 2.9"; of too few samples
// without quantiles.
std::string in_words(const UncertainOutput& o, double level) {
  const Spread& s = o.spread;
  return fmt::format(
      "{} = {:.6g} {}: {}standard uncertainty {:.3g}", o.output.name, o.nominal, o.output.unit,
      is_computed(s.low.value) ? fmt::format("{} of the pumps in {:.6g} .. {:.6g}, ",
                                             percent(level), s.low.value, s.high.value)
                               : "",
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
  if (const std::string few = result.too_few_text(); !few.empty()) text += "; " + few;
  return text;
}

// Two significant digits, also of 100 %: never in powers of ten.
std::string percent_text(double share) {
  return std::abs(share) >= 0.0995 ? fmt::format("{:.0f} %", 100 * share)
                                   : fmt::format("{:.2g} %", 100 * share);
}

// What a parameter contributes to an output, to first order. @param at  as for_each_pair has it
double contribution(const UncertaintyResult& result, std::size_t at) {
  const std::size_t variable = at % result.variables.size();
  return result.first_order.derivatives[at] *
         result.variables.distributions[variable].standard_deviation();
}
report::Values contributions(const UncertaintyResult& result, std::size_t o) {
  const std::size_t n = result.variables.size();
  return report::values_at(n, [&](std::size_t i) { return contribution(result, o * n + i); });
}

// use(output, variable, place in the lists of all pairs) of every output and variable.
template <class Use>
void for_each_pair(const UncertaintyResult& result, const Use& use) {
  std::size_t at = 0;
  for (const UncertainOutput& o : result.outputs)
    for (const Variable& variable : result.variables.variables) use(o.output, variable, at++);
}

// The parameters that make most of an output's variance, to first order: "pump.tilt_deg 78 %".
std::string largest_shares(const UncertaintyResult& result, std::size_t o) {
  constexpr std::size_t kNamed = 2;
  const std::size_t n = result.variables.size();
  const report::Values parts = contributions(result, o);
  double sum = 0;
  for (const double part : parts) {
    if (!is_computed(part)) return "";
    sum += part * part;
  }
  if (!(sum > 0) || !result.variables.independent()) return "";
  auto order = report::by_size(n, [&](std::size_t i) { return parts[i] * parts[i]; });
  order.resize(std::min(kNamed, n));
  return joined(order, ", ", [&](std::size_t i) {
    return result.variables.variables[i].name() + " " + percent_text(parts[i] * parts[i] / sum);
  });
}

std::string variance_text(const UncertaintyResult& result, std::size_t o) {
  const std::string shares = result.options.first_order ? largest_shares(result, o) : "";
  return shares.empty() ? "" : "; of its variance " + shares;
}

// What each output may be, and what makes most of it.
std::vector<std::string> answers_of(const UncertaintyResult& result) {
  std::vector<std::string> answers;
  for (std::size_t o = 0; o < result.outputs.size(); ++o)
    answers.push_back(in_words(result.outputs[o], result.options.level) + variance_text(result, o) +
                      ".");
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
  if (!is_computed(e.value)) return "too few samples";
  const double width = e.high - e.low;
  return digits(e.value, width) + " (" + digits(e.low, width) + " .. " + digits(e.high, width) +
         ")";
}

Section outputs_section(const UncertaintyResult& result) {
  const double tail = (1 - result.options.level) / 2;
  NewSection section(
      "Outputs",
      fmt::format(
          "Monte Carlo: {} independent samples, random numbers of seed {}. In brackets the "
          "interval that holds the quantile with 95 % probability, by order statistics; behind +- "
          "the standard error. Nominal: the case as it is. All digits are in outputs.csv.",
          result.options.samples, result.options.seed));
  section.columns("output", "unit", "nominal", "mean", "standard deviation",
                  percent(tail) + " quantile", "median", percent(1 - tail) + " quantile");
  for (const auto& [output, nominal, s] : result.outputs)
    section.row(output.name, output.unit, digits(nominal, s.mean_error),
                with_error(s.mean, s.mean_error), with_error(s.deviation, s.deviation_error),
                with_interval(s.low), with_interval(s.median), with_interval(s.high));
  return section;
}

Section first_order_section(const UncertaintyResult& result) {
  NewSection section(
      "First order beside it",
      "Law of propagation of uncertainty (JCGM 100, 5.1 and 5.2): value at the parameters' means, "
      "combined standard uncertainty from derivatives there and covariances. Where it differs from "
      "Monte Carlo by more than the latter's standard error, the output is not linear over the "
      "range of uncertainty; Monte Carlo is then valid.");
  section.columns("output", "unit", "value at the means", "combined standard uncertainty",
                  "of Monte Carlo", "standard error of that");
  if (!result.sampled.infeasible.empty())
    section.fact("left-out samples",
                 "First order takes the stated distributions as a whole, Monte Carlo only "
                 "the samples that are pumps: the two differ by that too.");
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    const auto& [output, nominal, spread] = result.outputs[o];
    section.row(output.name, output.unit, result.first_order.values[o],
                result.first_order.deviations[o], spread.deviation, spread.deviation_error);
  }
  for (const std::string& reason : result.first_order.reasons)
    section.fact("no derivative", reason);
  return section;
}

Section contributions_section(const UncertaintyResult& result) {
  NewSection section("Contributions of the parameters, to first order",
                     "Derivative by differences over half and a quarter of the standard deviation, "
                     "extrapolated; its error is what the extrapolation changed. Contribution: "
                     "derivative x standard deviation of the parameter.");
  section.columns("output", "parameter", "derivative", "error of it", "unit of it", "contribution",
                  "unit");
  for_each_pair(result, [&](const Output& output, const Variable& v, std::size_t at) {
    const std::string of = output.unit.empty() ? "1" : output.unit;
    section.row(output.name, v.name(), result.first_order.derivatives[at],
                result.first_order.derivative_errors[at],
                v.unit().empty() ? of : of + "/" + v.unit(), contribution(result, at), output.unit);
  });
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
  NewSection section(
      "Sobol indices",
      "Shares of the output's variance: first, by the parameter alone; total, by it together with "
      "others. Martinez' estimator (OpenTURNS), with the interval of 95 % that it has at "
      "independent points; the points are a Sobol sequence, so that it errs on the safe side.");
  section.columns("output", "parameter", "first", "from", "to", "total", "from", "to");
  section.fact("evaluations", std::to_string(result.sobol.evaluations));
  section.fact("base points left out", sobol_left_out_text(result));
  for_each_pair(result, [&](const Output& output, const Variable& variable, std::size_t at) {
    const Estimate &first = result.sobol.first[at], &total = result.sobol.total[at];
    section.row(output.name, variable.name(), first.value, first.low, first.high, total.value,
                total.low, total.high);
  });
  return section;
}

report::Figure contributions_figure(const UncertaintyResult& result, std::size_t o) {
  const Output& output = result.outputs[o].output;
  const report::Values parts = contributions(result, o);
  const auto size = [&](std::size_t i) { return std::abs(parts[i]); };
  const auto order = report::by_size(parts.size(), size);
  report::BarsFigure bars{{"contribution to " + output.name, output.unit}, {}};
  constexpr double kDrawn = 1e-6;  // of the largest: the rest may be round-off
  for (const std::size_t i : order)
    if (size(i) > kDrawn * size(order.front()))
      bars.bars.push_back({result.variables.variables[i].name(), -size(i), size(i),
                           result.variables.distributions[i].text() + ": " +
                               fmt::format("{:+.3g} {}", parts[i], output.unit)});
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

Section reasons_section(const UncertaintyResult& result) {
  std::map<std::string, long> counts;
  for (const auto& [index, reason] : result.sampled.infeasible) ++counts[reason];
  const std::size_t without = result.sampled.infeasible.size(), all = result.options.samples;
  NewSection section("Samples that are no pump",
                     "Left out of all results above: these apply to the feasible pumps.");
  section.fact("samples", "{} of {}", without, all);
  section.fact("share, %", "{:.3g}", 100 * static_cast<double>(without) / static_cast<double>(all));
  section.columns("reason", "samples");
  constexpr std::size_t kMax = 20;
  for (const auto& [reason, count] : counts)
    if (section.table.rows.size() < kMax) section.row(reason, count);
  if (counts.size() > kMax)
    section.fact("reasons not listed", std::to_string(counts.size() - kMax));
  return section;
}

Section kept_section(const UncertaintyResult& result) {
  NewSection section(
      "Parameters of the remaining samples",
      "Leaving samples out changes the distributions of the parameters: where mean or "
      "standard deviation of the samples that are left differ from the stated ones by more "
      "than their standard errors, mean, standard deviation and quantiles of the outputs "
      "are those of these narrower distributions, not of the stated ones.");
  section.columns("parameter", "unit", "stated mean", "mean", "standard error of it",
                  "stated standard deviation", "standard deviation", "standard error of it");
  for (std::size_t i = 0; i < result.kept_parameters.size(); ++i) {
    const Spread& s = result.kept_parameters[i];
    const Distribution& d = result.variables.distributions[i];
    section.row(result.variables.variables[i].name(), result.variables.variables[i].unit(),
                d.mean(), s.mean, s.mean_error, d.standard_deviation(), s.deviation,
                s.deviation_error);
  }
  return section;
}

}  // namespace

Section parameters_section(const UncertaintyResult& result) {
  NewSection section("What is not known");
  section.columns("parameter", "unit", "in the case", "distribution", "mean", "standard deviation",
                  "over the mean, %");
  const UncertainVariables& all = result.variables;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Distribution& d = all.distributions[i];
    const double mean = d.mean(), deviation = d.standard_deviation();
    section.row(all.variables[i].name(), all.variables[i].unit(),
                all.variables[i].value(result.the_case), d.text(), mean, deviation,
                mean != 0 ? 100 * deviation / std::abs(mean) : not_computed());
  }
  for (const UncertaintyData::Correlation& c : result.the_case.uncertainty.correlations)
    section.fact("correlation of " + c.first + " and " + c.second, number_text(c.coefficient));
  return section;
}

void add_left_out(report::Document& document, const UncertaintyResult& result) {
  if (result.sampled.infeasible.empty()) return;
  report::append(document.warnings, report::Warning{"Samples left out", left_out_text(result)});
  report::append(document.runs, reasons_section(result));
  report::append(document.runs, kept_section(result));
}

Section bands_section(const UncertaintyResult& result) {
  NewSection section(
      "Bands on reactions",
      fmt::format("Pointwise quantiles of {} samples: at each angle {} of the pumps are inside. "
                  "Fewer are inside throughout the turn: the table gives this share. An edge is "
                  "known within its interval of 95 %, by order statistics.",
                  result.options.samples - result.sampled.infeasible.size(),
                  percent(result.options.level)));
  section.columns("channel", "unit", "peak of the vector", "largest half width", "of peak, %",
                  "largest half interval of an edge", "of peak, %", "within throughout, %");
  for (const CurveBand& b : result.bands) {
    const auto of_peak = [&](double value) {
      return b.peak > 0 ? 100 * value / b.peak : not_computed();
    };
    section.row(b.channel.name, b.channel.unit, b.peak, b.widest, of_peak(b.widest), b.edge_error,
                of_peak(b.edge_error), 100 * b.throughout);
  }
  if (result.theta_deg.size() < result.angles)
    section.fact("angles", "{} of the case's {}, to fit into memory", result.theta_deg.size(),
                 result.angles);
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
  document.verdict = {.agrees = std::nullopt,
                      .headline = headline(result),
                      .word = "Uncertainty",
                      .answers = answers_of(result)};
  document.meaning = "Effect of the stated distributions of parameters on the results of the " +
                     study::to_string(result.options.model) +
                     " model. Effects that the model leaves out and parameters without a "
                     "distribution are not included.";
  document.runs = {parameters_section(result)};
  document.figures.emplace();
  const auto add_figures = [&](const auto& figure_of) {
    for (std::size_t o = 0; o < result.outputs.size(); ++o)
      document.figures->push_back(figure_of(result, o));
  };
  if (!result.outputs.empty()) document.runs->push_back(outputs_section(result));
  if (!result.outputs.empty() && result.options.first_order) {
    document.runs->push_back(first_order_section(result));
    document.runs->push_back(contributions_section(result));
    add_figures(contributions_figure);
  }
  if (!result.outputs.empty() && result.options.sobol > 0) {
    document.runs->push_back(sobol_section(result));
    add_figures(sobol_figure);
  }
  if (!result.bands.empty()) {
    document.runs->push_back(bands_section(result));
    append(document.figures, band_figures(result));
  }
  if (const std::string few = result.too_few_text(); !few.empty())
    report::append(document.warnings, report::Warning{"Few samples", few + "."});
  add_left_out(document, result);
  return document;
}

std::string uncertainty_text(const UncertaintyResult& result) {
  std::string text = result.the_case.name + "\n";
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    text += in_words(result.outputs[o], result.options.level);
    if (result.options.first_order)
      text += fmt::format(", to first order {:.3g}", result.first_order.deviations[o]);
    text += variance_text(result, o) + "\n";
  }
  if (result.options.sobol > 0)
    for_each_pair(result, [&](const Output& output, const Variable& variable, std::size_t at) {
      const Estimate& first = result.sobol.first[at];
      text += output.name + ": " + variable.name() + ": ";
      text += is_computed(first.value) ? "first " + share_text(first) + ", total " +
                                             share_text(result.sobol.total[at]) + "\n"
                                       : "no indices, the output does not vary\n";
    });
  const auto of_peak = [](const CurveBand& b) {
    return b.peak > 0 ? b.widest / b.peak : not_computed();
  };
  if (const CurveBand* widest = report::largest_of(result.bands, of_peak))
    text += fmt::format("widest band: {}, +-{:.3g} {}, {} of peak\n", widest->channel.name,
                        widest->widest, widest->channel.unit, percent_text(of_peak(*widest)));
  if (const std::string few = result.too_few_text(); !few.empty()) text += few + "\n";
  if (!result.sampled.infeasible.empty())
    text += left_out_text(result) +
            "; the first reason: " + result.sampled.infeasible.front().second + "\n";
  return text;
}

}  // namespace bentaxis::designs

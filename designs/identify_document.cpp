#include "bentaxis/designs/identify_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bentaxis/pump/number.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/study/plausibility_section.h"

namespace bentaxis::designs {
namespace {

using report::Cell;
using report::Section;

// Largest R-hat of walkers that have settled (Vehtari et al. 2021 ask for 1.01 of long chains).
constexpr double kSettled = 1.1;

// The largest R-hat of walkers that have not settled.
std::optional<double> unsettled(const Identification& result) {
  const auto& rhat = result.posterior.rhat;
  if (result.posterior.count == 0 || rhat.empty()) return std::nullopt;
  const double largest = *std::max_element(rhat.begin(), rhat.end());
  return largest <= kSettled ? std::nullopt : std::optional(largest);
}

struct Quantiles {
  double low = not_computed(), middle = not_computed(), high = not_computed();
};

// Of one column of the draws.
Quantiles quantiles_of(const std::vector<double>& draws, std::size_t columns, std::size_t column) {
  std::vector<double> values;
  for (std::size_t at = column; at < draws.size(); at += columns)
    if (is_computed(draws[at])) values.push_back(draws[at]);
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.025), at(0.5), at(0.975)};
}

Cell cell(double value) { return is_computed(value) ? Cell(value) : Cell(); }

std::string known_text(const DataModel& model, const Datum& datum) {
  std::string at = model.data().conditions[datum.condition].name;
  if (!datum.variant.empty()) at += (at.empty() ? "" : "; ") + datum.variant;
  return at;
}

// What is known of a datum from outside.
std::string given_text(const Datum& datum) {
  if (datum.curve)
    return fmt::format("{} points +- {:.3g}", datum.curve->values.size(), datum.uncertainty);
  if (datum.value) return fmt::format("{:.6g} +- {:.2g}", *datum.value, datum.uncertainty);
  if (!std::isfinite(datum.low)) return fmt::format("below {:g}", datum.high);
  if (!std::isfinite(datum.high)) return fmt::format("above {:g}", datum.low);
  return fmt::format("{:g} to {:g}", datum.low, datum.high);
}

// The model's number for a datum, of its range both.
std::string number_text(const Datum& datum, double low, double high) {
  if (datum.curve || !is_computed(low)) return "";
  return low == high ? fmt::format("{:.6g}", low) : fmt::format("{:.5g} to {:.5g}", low, high);
}

double worst_residual(const DataModel& model, const Identification& result, std::size_t i) {
  const Datum& datum = model.data().data[i];
  double worst = 0;
  for (std::size_t k = 0; k < datum.size(); ++k) {
    const double r = model.residual(datum, k, result.numbers[model.place_of(i) + k]);
    if (std::abs(r) > std::abs(worst)) worst = r;
  }
  return worst;
}

Section unknowns_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Unknowns";
  section.text =
      "Identified: the least sum of squares. Linear: standard uncertainty as if the model were "
      "linear there and bounds normal. Profile: 95 % limits, the others fitted anew; a limit at a "
      "bound is the bound's, not the data's. Posterior: 95 % of the draws.";
  section.table.columns = {"unknown",
                           "unit",
                           "bounds",
                           "identified",
                           "linear",
                           "profile from",
                           "profile to",
                           "open at a bound",
                           "2.5 % from",
                           "97.5 % to",
                           "share of bounds left"};
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    const Quantiles q = quantiles_of(result.posterior.unknowns, model.size(), i);
    std::vector<Cell> row = {u.name(), u.variable.unit(),
                             fmt::format("{:g} to {:g}", u.low, u.high), result.fit.x[i],
                             result.information.deviation[i]};
    if (result.profiles.empty()) {
      row.insert(row.end(), {Cell(), Cell(), Cell()});
    } else {
      const Profile& p = result.profiles[i];
      row.insert(row.end(), {p.low, p.high,
                             std::string(p.open_low && p.open_high ? "both"
                                         : p.open_low              ? "low"
                                         : p.open_high             ? "high"
                                                                   : "")});
    }
    row.insert(row.end(), {cell(q.low), cell(q.high), cell((q.high - q.low) / (u.high - u.low))});
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

Section determined_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "What the data determine";
  section.text =
      "From the derivatives of the fitted data at the solution. A window that is kept says nothing "
      "there, although it limits how far one can go: profiles and posterior know.";
  for (const std::string& line : result.information.words) section.facts.emplace_back("", line);
  section.table.columns = {"direction", "times narrower than the bounds", "mostly along"};
  for (std::size_t d = 0; d < result.information.directions.size(); ++d) {
    const Direction& direction = result.information.directions[d];
    std::vector<std::pair<double, std::size_t>> parts;
    for (std::size_t i = 0; i < direction.weights.size(); ++i)
      if (std::abs(direction.weights[i]) > 0.2)
        parts.emplace_back(-std::abs(direction.weights[i]), i);
    std::sort(parts.begin(), parts.end());
    std::string along;
    for (const auto& [size, i] : parts)
      along += fmt::format("{}{:+.2f} {}", along.empty() ? "" : ", ", direction.weights[i],
                           model.data().unknowns[i].name());
    section.table.rows.push_back({static_cast<long>(d + 1), direction.strength, along});
  }
  return section;
}

Section fitted_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Data that unknowns are fitted to";
  section.text =
      "Residual: model minus datum over its standard uncertainty, 0 inside a window. Left out: "
      "what "
      "the others predict for it, with its bounds as normal priors, and how far off that is over "
      "the standard uncertainty of prediction and datum together.";
  section.table.columns = {"datum", "where", "at",       "unit",
                           "given", "model", "residual", "left out: predicted",
                           "+-",    "off by"};
  for (std::size_t i = 0; i < model.data().data.size(); ++i) {
    const Datum& datum = model.data().data[i];
    if (datum.use != Use::fitted) continue;
    const std::size_t place = model.place_of(i);
    std::vector<Cell> row = {
        datum.what,
        datum.where,
        known_text(model, datum),
        datum.unit,
        given_text(datum),
        number_text(datum, result.numbers[place], result.numbers[place + datum.size() - 1]),
        worst_residual(model, result, i)};
    const auto left = std::find_if(result.left_out.begin(), result.left_out.end(),
                                   [&](const LeftOut& l) { return l.datum == i; });
    if (left == result.left_out.end())
      row.insert(row.end(), {Cell(), Cell(), Cell()});
    else
      row.insert(row.end(),
                 {number_text(datum, left->value, left->high), left->deviation, left->distance});
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

Section predicted_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Data that are predicted";
  section.text = "Nothing was fitted to them. Band: 95 % of the posterior; of a range its ends.";
  section.table.columns = {"datum",      "where",     "at",
                           "unit",       "given",     "model",
                           "2.5 % from", "97.5 % to", "the band meets it"};
  for (std::size_t i = 0; i < model.data().data.size(); ++i) {
    const Datum& datum = model.data().data[i];
    if (datum.use != Use::predicted) continue;
    const std::size_t place = model.place_of(i), last = place + datum.size() - 1;
    std::vector<Cell> row = {datum.what,
                             datum.where,
                             known_text(model, datum),
                             datum.unit,
                             given_text(datum),
                             number_text(datum, result.numbers[place], result.numbers[last])};
    const double low = quantiles_of(result.posterior.numbers, model.numbers(), place).low;
    const double high = quantiles_of(result.posterior.numbers, model.numbers(), last).high;
    if (datum.curve || !is_computed(low)) {
      row.insert(row.end(), {Cell(), Cell(), Cell()});
    } else {
      const double from = datum.value ? *datum.value - 2 * datum.uncertainty : datum.low;
      const double to = datum.value ? *datum.value + 2 * datum.uncertainty : datum.high;
      const bool meets = datum.size() == 2 ? low >= from && high <= to : low <= to && high >= from;
      row.insert(row.end(), {low, high, meets ? "yes" : "no"});
    }
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

Section left_out_section(const DataModel& model) {
  Section section;
  section.title = "Data that are left out";
  section.table.columns = {"datum", "where", "why"};
  for (const Datum& datum : model.data().data)
    if (datum.use == Use::left_out)
      section.table.rows.push_back({datum.what, datum.where, datum.reason});
  return section;
}

Section reactions_section(const DataModel& model, const Identification& result) {
  const ChannelLayout layout(model.base().pump.geometry.pistons);
  Section section;
  section.title = "How well each reaction is known";
  section.text =
      "Half the width of the 95 % band where it is widest, of the peak of its middle curve, at the "
      "case's own speed and pressure. Parameters that are not unknown count as known.";
  section.table.columns = {"reaction", "half width, % of peak"};
  for (const ReactionBand& band : result.bands)
    section.table.rows.push_back({layout.channels()[band.column].name, 100 * band.half_width});
  return section;
}

Section candidates_section(const Identification& result) {
  constexpr std::size_t kShown = 12;
  Section section;
  section.title = "Which measurement would help most";
  section.text =
      "By how much the bands would become narrower, mean over the reactions, if that number were "
      "measured too: linear, from the covariances of the draws.";
  section.table.columns = {"measurement", "measured to, standard",
                           "unit",        "all bands narrower by, %",
                           "most",        "that one by, %"};
  for (std::size_t c = 0; c < std::min(kShown, result.candidates.size()); ++c) {
    const Candidate& k = result.candidates[c];
    section.table.rows.push_back(
        {k.output.name, k.deviation, k.output.unit, 100 * k.shrinks, k.most, 100 * k.most_shrinks});
  }
  return section;
}

Section search_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Search";
  section.facts = {{"least squares", least_squares_library()},
                   {"sum of squares", fmt::format("{:.4g}", result.fit.sum_of_squares)},
                   {"residuals", std::to_string(result.fit.residuals.size())},
                   {"unknowns", std::to_string(model.size())}};
  if (result.posterior.count > 0) {
    const auto& p = result.posterior;
    section.facts.emplace_back("moves accepted", fmt::format("{:.0f} %", 100 * p.accepted));
    section.facts.emplace_back("independent draws, of the worst unknown",
                               unsettled(result) ? "not known: the walkers have not settled"
                                                 : fmt::format("{:.0f}", p.effective));
    section.facts.emplace_back(
        "largest R-hat", fmt::format("{:.3f}", *std::max_element(p.rhat.begin(), p.rhat.end())));
  }
  section.table.columns = {"minimum", "sum of squares", "starts that led there"};
  for (std::size_t m = 0; m < result.minima.size(); ++m)
    section.table.rows.push_back({static_cast<long>(m + 1), result.minima[m].sum_of_squares,
                                  static_cast<long>(result.minima[m].starts)});
  return section;
}

std::vector<report::Figure> figures_of(const DataModel& model, const Identification& result) {
  std::vector<report::Figure> figures;
  if (!result.bands.empty()) {
    const ChannelLayout layout(model.base().pump.geometry.pistons);
    report::BarsFigure known{{"half width of the 95 % band", "% of peak"}, {}};
    for (const ReactionBand& band : result.bands)
      known.bars.push_back({layout.channels()[band.column].name, 0, 100 * band.half_width});
    figures.push_back({"known", "How well each reaction is known", "", known});
    for (const ReactionBand& band : result.bands) {
      const Channel& channel = layout.channels()[band.column];
      report::BandFigure figure;
      figure.x = {"shaft angle", "deg"};
      figure.y = {channel.quantity + " " + channel.axis, channel.unit};
      figure.angle = true;
      figure.x_values = result.theta_deg;
      figure.bands = {{"95 % of the posterior", band.low, band.middle, band.high}};
      figures.push_back({"band_" + channel.name, channel.name + ": what the data leave open", "",
                         std::move(figure)});
    }
  }
  for (std::size_t i = 0; i < result.profiles.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    const Profile& p = result.profiles[i];
    if (p.values.size() < 3) continue;
    figures.push_back(
        {fmt::format("profile_{}", i + 1), "Profile of " + u.name(), "",
         report::XyFigure{{u.name(), u.variable.unit()},
                          {"rise of the sum of squares", "", false, 0},
                          {{"others fitted anew", p.values, p.rises},
                           {"95 %", {p.values.front(), p.values.back()}, {3.841, 3.841}}}}});
  }
  return figures;
}

std::string headline_of(const DataModel& model, const Identification& result) {
  int fitted = 0, open = 0;
  for (const Datum& datum : model.data().data) fitted += datum.use == Use::fitted;
  for (const Direction& direction : result.information.directions) open += direction.strength < 2;
  std::string text = fmt::format(
      "unknowns: {}; data they are fitted to: {}; {} of {} directions become less than half as "
      "wide as "
      "the bounds",
      model.size(), fitted, static_cast<int>(model.size()) - open, model.size());
  if (result.bands.empty()) return text;
  const auto [best, worst] = std::minmax_element(
      result.bands.begin(), result.bands.end(),
      [](const ReactionBand& a, const ReactionBand& b) { return a.half_width < b.half_width; });
  const ChannelLayout layout(model.base().pump.geometry.pistons);
  return text + fmt::format("; reactions are known to {:.2g} % ({}) .. {:.2g} % ({}) of peak",
                            100 * best->half_width, layout.channels()[best->column].name,
                            100 * worst->half_width, layout.channels()[worst->column].name);
}

}  // namespace

report::Document identify_document(const DataModel& model, const Identification& result,
                                   const report::Lines& program) {
  report::Document document;
  document.title = "Identification: " + model.base().name;
  document.program = program;
  study::describe_case(document, model.base());
  document.verdict = report::Verdict{std::nullopt, headline_of(model, result)};
  document.meaning =
      "What data say about the parameters of the model, given that the model is right and that "
      "what is not unknown is known. It is no validation: only data that nothing was fitted to "
      "are.";
  if (const auto rhat = unsettled(result))
    document.warnings = {
        {"Posterior not settled",
         fmt::format("R-hat {:.3g}, above {:g}: the walkers still are where they began, and bands "
                     "are a rough size only. More --steps, fewer unknowns or narrower bounds help",
                     *rhat, kSettled)}};
  document.runs = {unknowns_section(model, result), determined_section(model, result),
                   fitted_section(model, result)};
  document.runs->push_back(predicted_section(model, result));
  document.runs->push_back(left_out_section(model));
  if (!result.bands.empty()) {
    document.runs->push_back(reactions_section(model, result));
    document.runs->push_back(candidates_section(result));
  }
  document.runs->push_back(search_section(model, result));
  document.figures = figures_of(model, result);
  return document;
}

std::string identify_text(const DataModel& model, const Identification& result) {
  std::string text = headline_of(model, result) + "\n";
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    text += fmt::format("{:<42} {:>12.6g} {:<8}", u.name(), result.fit.x[i], u.variable.unit());
    if (!result.profiles.empty())
      text += fmt::format(" 95 %: {:.5g}{} to {:.5g}{}", result.profiles[i].low,
                          result.profiles[i].open_low ? " (bound)" : "", result.profiles[i].high,
                          result.profiles[i].open_high ? " (bound)" : "");
    text += "\n";
  }
  for (const std::string& line : result.information.words) text += line + "\n";
  if (const auto rhat = unsettled(result))
    text +=
        fmt::format("posterior not settled: R-hat {:.3g}; bands are a rough size only\n", *rhat);
  if (!result.candidates.empty())
    text += fmt::format("most useful further measurement: {}\n", result.candidates[0].output.name);
  text.pop_back();
  return text;
}

std::string unknowns_csv(const DataModel& model, const Identification& result) {
  std::string text =
      "unknown,unit,low,high,identified,linear_deviation,profile_low,profile_high,q025,q500,q975\n";
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    const Quantiles q = quantiles_of(result.posterior.unknowns, model.size(), i);
    text += u.name() + "," + u.variable.unit();
    for (const double value : {u.low, u.high, result.fit.x[i], result.information.deviation[i],
                               result.profiles.empty() ? not_computed() : result.profiles[i].low,
                               result.profiles.empty() ? not_computed() : result.profiles[i].high,
                               q.low, q.middle, q.high})
      text += is_computed(value) ? fmt::format(",{}", value) : ",";
    text += "\n";
  }
  return text;
}

std::string bands_csv(const DataModel& model, const Identification& result) {
  if (result.bands.empty()) return "";
  const ChannelLayout layout(model.base().pump.geometry.pistons);
  std::string text = "theta_deg";
  for (const ReactionBand& band : result.bands)
    for (const char* part : {"q025", "q500", "q975"})
      text += "," + layout.channels()[band.column].name + "_" + part;
  text += "\n";
  for (std::size_t row = 0; row < result.theta_deg.size(); ++row) {
    text += fmt::format("{}", result.theta_deg[row]);
    for (const ReactionBand& band : result.bands)
      text += fmt::format(",{},{},{}", band.low[row], band.middle[row], band.high[row]);
    text += "\n";
  }
  return text;
}

}  // namespace bentaxis::designs

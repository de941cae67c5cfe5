#include "bentaxis/designs/identify_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "answers_text.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/channels.h"
#include "document_parts.h"

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
  if (datum.value)
    return fmt::format("{:.6g} +- {:g}", *datum.value, rounded(datum.uncertainty, 2));
  if (!std::isfinite(datum.low)) return fmt::format("below {:g}", datum.high);
  if (!std::isfinite(datum.high)) return fmt::format("above {:g}", datum.low);
  return fmt::format("{:g} to {:g}", datum.low, datum.high);
}

// The model's number for a datum, of its range both.
std::string number_text(const Datum& datum, double low, double high) {
  if (datum.curve || !is_computed(low)) return "";
  return low == high ? fmt::format("{:.6g}", low) : fmt::format("{:.5g} to {:.5g}", low, high);
}

double worst_residual(const Identification& result, std::size_t datum) {
  const auto worst = std::find_if(result.worst.begin(), result.worst.end(),
                                  [&](const WorstResidual& w) { return w.datum == datum; });
  return worst == result.worst.end() ? 0 : worst->residual;
}

// ---- Unknowns at a bound

const HeldUnknown* held_of(const Identification& result, std::size_t unknown) {
  const auto at = std::find_if(result.held.begin(), result.held.end(),
                               [&](const HeldUnknown& h) { return h.unknown == unknown; });
  return at == result.held.end() ? nullptr : &*at;
}

// "pump.tilt_deg ends at the upper bound 39 of its range 38 to 39"
std::string held_text(const DataModel& model, const HeldUnknown& held) {
  const Unknown& u = model.data().unknowns[held.unknown];
  return fmt::format("{} ends at the {} bound {:g} of its range {:g} to {:g}", u.name(),
                     held.high ? "upper" : "lower", held.high ? u.high : u.low, u.low, u.high);
}

// The same with what follows.
std::string held_line(const DataModel& model, const HeldUnknown& held) {
  return fmt::format(
      "{}: the value that the data want lies outside of it, or the bound is wrong (chi-square "
      "would fall by about {:.3g} there)",
      held_text(model, held), held.gain);
}

std::string held_names(const DataModel& model, const Identification& result) {
  std::vector<std::string> names;
  for (const HeldUnknown& held : result.held)
    names.push_back(model.data().unknowns[held.unknown].name());
  return report::joined(names);
}

// What is not known because of them.
std::string only_within(const DataModel& model, const Identification& result) {
  return "They hold only if the bound is right at which this ends: " + held_names(model, result) +
         ".";
}

// ---- Goodness of fit

constexpr std::size_t kWorstShown = 10, kWorstPrinted = 5;
constexpr std::size_t kFurtherShown = 5;
constexpr const char* kWithheld =
    "Profile limits, posterior, bands of the reactions and useful further measurements are "
    "withheld: they would hold only if the model were right.";

std::string chi_square_text(double value) {
  return value < 1e4 || value > 1e15 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}
std::string p_text(double p) {
  return p < 1e-300 ? "p below 1e-300" : fmt::format("p = {:.2g}", p);
}

// "chi-square 70.1 with 73 degrees of freedom, p = 0.57"
std::string test_text(const GoodnessOfFit& fit) {
  std::string text = fmt::format("chi-square {} with {} degrees of freedom",
                                 chi_square_text(fit.chi_square), fit.degrees_of_freedom());
  return fit.p_value ? text + ", " + p_text(*fit.p_value) : text;
}

// The same with what it means.
std::string fit_text(const GoodnessOfFit& fit) {
  const std::string test = test_text(fit);
  if (fit.refuted())
    return fit.p_value ? fmt::format("the model does not fit the data: {} (refuted below {:g})",
                                     test, kFitRefutedBelow)
                       : "the model does not fit the data: " + test +
                             ", where a fit passes through all data";
  if (!fit.p_value) return "no test of the fit: " + test;
  if (fit.uncertainties_too_large())
    return fmt::format(
        "fit: {}: not refuted; residuals are smaller than expected from the stated uncertainties",
        test);
  return fmt::format("fit: {}: not refuted", test);
}

std::string birge_text(const GoodnessOfFit& fit) {
  return fmt::format(
      "Linear standard deviations are widened: they hold for data with all stated uncertainties "
      "multiplied by {:.3g}, the root of chi-square over the degrees of freedom (Birge ratio). "
      "This accounts for uncertainties that were stated too small. It does not account for a wrong "
      "model: true values can lie outside.",
      fit.birge_ratio());
}

// Given and model of a worst residual; of a prior its distribution and the unknown.
std::pair<std::string, std::string> worst_values(const DataModel& model,
                                                 const Identification& result,
                                                 const WorstResidual& worst) {
  if (worst.unknown)
    return {model.data().unknowns[*worst.unknown].prior->text(),
            fmt::format("{:.6g}", result.fit.x[*worst.unknown])};
  const Datum& datum = model.data().data[*worst.datum];
  const double of_model = result.numbers[model.place_of(*worst.datum) + worst.number];
  const std::string given = datum.curve
                                ? fmt::format("{:.6g} +- {:g}", datum.curve->values[worst.number],
                                              rounded(datum.curve->uncertainties[worst.number], 2))
                                : given_text(datum);
  return {given, fmt::format("{:.6g}", of_model)};
}

std::string worst_line(const DataModel& model, const Identification& result,
                       const WorstResidual& worst) {
  const auto [given, of_model] = worst_values(model, result, worst);
  const std::string unit = worst.datum ? model.data().data[*worst.datum].unit
                                       : model.data().unknowns[*worst.unknown].variable.unit();
  return fmt::format("{}: {:+.1f} sigma (data {}, model {}{}{})", name_of(model, worst),
                     worst.residual, given, of_model, unit.empty() ? "" : " ", unit);
}

// "friction.piston_coulomb_N (119.8 N instead of 0): chi-square .."
std::string further_line(const DataModel& model, const FurtherUnknown& f) {
  const std::string unit = f.variable.unit();
  std::string text =
      fmt::format("{} ({:.6g}{}{} instead of {:g}): {} would remain", f.variable.name(), f.value,
                  unit.empty() ? "" : " ", unit, f.before, test_text(f.fit));
  if (f.fit.refuted()) text += ", still refuted";
  if (!model.base().analytic.piston_friction && f.variable.name().starts_with("friction.piston_"))
    text += "; it acts with piston_friction = true of [assumptions.analytic] only";
  if (!f.implausible.empty())
    text += "; the value is implausible: " + report::joined(f.implausible);
  return text;
}

// Names of those that the data cannot tell from the best: the rise of chi-square would be within
// what one unknown's 95 % interval allows.
std::vector<std::string> as_good_as_best(const Identification& result) {
  constexpr double kRise95 = 3.841;
  std::vector<std::string> names;
  for (std::size_t k = 1; k < result.further.size(); ++k)
    if (result.further[k].implausible.empty() &&
        result.further[k].fit.chi_square < result.further[0].fit.chi_square + kRise95)
      names.push_back(result.further[k].variable.name());
  return names;
}

std::string further_text(const DataModel& model, const Identification& result) {
  if (result.further.empty()) return "no single further parameter of the case improves the fit";
  std::string text = "the further unknown that would improve the fit most: " +
                     further_line(model, result.further.front());
  if (const auto names = as_good_as_best(result); !names.empty())
    text += ". The data do not distinguish it from " + report::joined(names);
  return text;
}

Section goodness_section(const Identification& result) {
  const GoodnessOfFit& fit = result.goodness;
  Section section;
  section.title = "Goodness of fit";
  section.text =
      "Chi-square: sum of the squared residuals, each over its standard uncertainty. p: "
      "probability of a larger chi-square if the model and all stated uncertainties are right and "
      "the data are independent of each other. The degrees of freedom are the data that count "
      "(values, points of curves, priors, windows that the fit leaves) less the directions of the "
      "unknowns that were fitted to them.";
  section.facts = {{"result", fit_text(fit)}};
  if (!fit.p_value)
    section.facts.emplace_back(
        "no test", "There are as many fitted unknowns as data: the model cannot be tested.");
  if (fit.refuted()) {
    section.facts.emplace_back("withheld", kWithheld);
    section.facts.emplace_back("widened", birge_text(fit));
  }
  section.table.columns = {
      "chi-square", "data that count", "fitted directions", "degrees of freedom",
      "p-value",    "refuted below",   "refuted",           "Birge ratio"};
  section.table.rows.push_back(
      {fit.chi_square, static_cast<long>(fit.residuals), static_cast<long>(fit.fitted_directions),
       static_cast<long>(fit.degrees_of_freedom()), fit.p_value ? Cell(*fit.p_value) : Cell(),
       kFitRefutedBelow, fit.refuted(), fit.p_value ? Cell(fit.birge_ratio()) : Cell()});
  return section;
}

Section worst_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Largest residuals";
  section.text =
      "Residual: model minus datum over its standard uncertainty (sigma); of a curve the worst "
      "point. Share of chi-square: of all points of the curve.";
  section.table.columns = {
      "datum", "unit", "given", "model", "residual, sigma", "share of chi-square, %"};
  for (std::size_t w = 0; w < std::min(kWorstShown, result.worst.size()); ++w) {
    const WorstResidual& worst = result.worst[w];
    const auto [given, of_model] = worst_values(model, result, worst);
    section.table.rows.push_back({name_of(model, worst),
                                  worst.datum
                                      ? model.data().data[*worst.datum].unit
                                      : model.data().unknowns[*worst.unknown].variable.unit(),
                                  given, of_model, worst.residual, 100 * worst.share});
  }
  return section;
}

Section further_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Which further unknown would improve the fit most";
  section.text =
      "All continuous parameters that are active in the case and not unknown were compared by the "
      "derivatives of the residuals. The most promising ones were each fitted together with the "
      "unknowns. A better fit does not prove that this parameter is wrong: several can have the "
      "same effect on the data.";
  section.facts = {{"result", further_text(model, result)}};
  section.table.columns = {"parameter", "unit",       "in the case",
                           "fitted",    "chi-square", "degrees of freedom",
                           "p-value",   "refuted",    "implausible"};
  for (std::size_t k = 0; k < std::min(kFurtherShown, result.further.size()); ++k) {
    const FurtherUnknown& f = result.further[k];
    section.table.rows.push_back({f.variable.name(), f.variable.unit(), f.before, f.value,
                                  f.fit.chi_square, static_cast<long>(f.fit.degrees_of_freedom()),
                                  f.fit.p_value ? Cell(*f.fit.p_value) : Cell(), f.fit.refuted(),
                                  report::joined(f.implausible)});
  }
  return section;
}

report::Verdict verdict_of(const Identification& result, std::string headline) {
  const GoodnessOfFit& fit = result.goodness;
  const bool tested = fit.p_value.has_value() || fit.refuted();
  report::Verdict verdict{tested ? std::optional(!fit.refuted()) : std::nullopt,
                          std::move(headline),
                          fit.refuted() ? "Refuted"
                          : tested      ? "Not refuted"
                                        : "Not tested"};
  verdict.fit = report::Verdict::Fit{fit.chi_square, static_cast<long>(fit.degrees_of_freedom()),
                                     fit.p_value, kFitRefutedBelow, fit.refuted()};
  return verdict;
}

// What the stated uncertainties are multiplied by in the linear standard deviations.
double widened_by(const Identification& result) {
  return result.goodness.refuted() ? result.goodness.birge_ratio() : 1;
}

Section unknowns_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "Unknowns";
  section.text =
      "Identified: minimum of the sum of squares. Linear: standard uncertainty of a linearised "
      "model with bounds as normal priors. Profile: 95 % limits, at which the sum of squares has "
      "increased by 3.841 with the other unknowns fitted again; a limit at a bound follows from "
      "the bound, not from the data. Posterior: 95 % of the draws. All of them are right only "
      "where the stated uncertainties are right: a rise of 3.841 means 95 % for that noise alone.";
  if (result.goodness.refuted()) {
    section.facts.emplace_back("withheld", kWithheld);
    section.facts.emplace_back("widened", birge_text(result.goodness));
  }
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
                           "share of bounds left",
                           "ends at"};
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
    const HeldUnknown* held = held_of(result, i);
    row.emplace_back(!held ? "" : held->high ? "its upper bound" : "its lower bound");
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

Section determined_section(const DataModel& model, const Identification& result) {
  Section section;
  section.title = "What the data determine";
  section.text =
      "From the derivatives of the fitted data at the solution. A window that is met has no "
      "derivative there, although it limits the range: profiles and posterior take it into "
      "account.";
  for (const HeldUnknown& held : result.held)
    section.facts.emplace_back("", held_line(model, held));
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
      "Residual: model minus datum over its standard uncertainty, 0 inside a window. "
      "Leave-one-out: prediction from the other data, with bounds as normal priors, and its error "
      "over the combined standard uncertainty of prediction and datum";
  section.text += result.goodness.refuted()
                      ? ", both as stated: as the fit is refuted, they are too small."
                      : ".";
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
        worst_residual(result, i)};
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

// The posterior's 95 % band of a predicted datum, and whether it meets the datum.
struct PredictedBand {
  double low, high;
  bool meets;
};
std::optional<PredictedBand> predicted_band(const DataModel& model, const Identification& result,
                                            std::size_t i) {
  const Datum& datum = model.data().data[i];
  const std::size_t place = model.place_of(i), last = place + datum.size() - 1;
  const double low = quantiles_of(result.posterior.numbers, model.numbers(), place).low;
  const double high = quantiles_of(result.posterior.numbers, model.numbers(), last).high;
  if (datum.curve || !is_computed(low)) return std::nullopt;
  const double from = datum.value ? *datum.value - 2 * datum.uncertainty : datum.low;
  const double to = datum.value ? *datum.value + 2 * datum.uncertainty : datum.high;
  return PredictedBand{low, high,
                       datum.size() == 2 ? low >= from && high <= to : low <= to && high >= from};
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
    if (const auto band = predicted_band(model, result, i))
      row.insert(row.end(), {band->low, band->high, band->meets ? "yes" : "no"});
    else
      row.insert(row.end(), {Cell(), Cell(), Cell()});
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
  const ChannelLayout layout(model.base().pump);
  Section section;
  section.title = "Uncertainty of each reaction";
  section.text =
      "Half the width of the 95 % band where it is widest, of the peak of its middle curve, at the "
      "case's own speed and pressure. All other parameters are taken as known.";
  if (!result.held.empty()) section.facts.emplace_back("", only_within(model, result));
  section.table.columns = {"reaction", "half width, % of peak"};
  for (const ReactionBand& band : result.bands)
    section.table.rows.push_back({layout.channels()[band.column].name, 100 * band.half_width});
  return section;
}

Section candidates_section(const Identification& result) {
  constexpr std::size_t kShown = 12;
  Section section;
  section.title = "Most useful further measurements";
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
                               unsettled(result) ? "not determined: the chains have not converged"
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
    const ChannelLayout layout(model.base().pump);
    report::BarsFigure known{{"half width of the 95 % band", "% of peak"}, {}};
    for (const ReactionBand& band : result.bands)
      known.bars.push_back({layout.channels()[band.column].name, 0, 100 * band.half_width});
    figures.push_back({"known", "Uncertainty of each reaction", "", known});
    for (const ReactionBand& band : result.bands) {
      const Channel& channel = layout.channels()[band.column];
      report::BandFigure figure;
      figure.x = {"shaft angle", "deg"};
      figure.y = {channel.quantity + " " + channel.axis, channel.unit};
      figure.angle = true;
      figure.x_values = result.theta_deg;
      figure.bands = {{"95 % of the posterior", band.low, band.middle, band.high}};
      figures.push_back({"band_" + channel.name, channel.name + ": what the data do not determine",
                         "", std::move(figure)});
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

// "3", "2 curves with 360 points", "5, of which 2 curves with 360 points".
std::string fitted_data_text(const DataModel& model) {
  std::size_t fitted = 0, curves = 0, points = 0;
  for (const Datum& datum : model.data().data)
    if (datum.use == Use::fitted) {
      ++fitted;
      if (datum.curve) {
        ++curves;
        points += datum.size();
      }
    }
  if (curves == 0) return std::to_string(fitted);
  const std::string text =
      fmt::format("{} curve{} with {} points", curves, curves == 1 ? "" : "s", points);
  return curves == fitted ? text : fmt::format("{}, of which {}", fitted, text);
}

std::string headline_of(const DataModel& model, const Identification& result) {
  int open = 0;
  std::string text = fmt::format("{}; unknowns: {}; data they are fitted to: {}",
                                 fit_text(result.goodness), model.size(), fitted_data_text(model));
  for (const HeldUnknown& held : result.held) text += "; " + held_text(model, held);
  if (result.goodness.refuted())
    return result.worst.empty() ? text
                                : text + "; worst: " + worst_line(model, result, result.worst[0]);
  for (const Direction& direction : result.information.directions) open += direction.strength < 2;
  if (result.held.empty())
    text += fmt::format("; {} of {} directions become less than half as wide as the bounds",
                        static_cast<int>(model.size()) - open, model.size());
  if (result.bands.empty()) return text;
  int predicted = 0, missed = 0;
  for (std::size_t i = 0; i < model.data().data.size(); ++i)
    if (model.data().data[i].use == Use::predicted)
      if (const auto band = predicted_band(model, result, i)) {
        ++predicted;
        missed += !band->meets;
      }
  if (missed > 0)
    text +=
        fmt::format("; {} of {} predicted data are outside their 95 % bands", missed, predicted);
  if (!result.held.empty())
    return text + "; how well reactions are known is not stated: bands hold only within that bound";
  const auto [best, worst] = std::minmax_element(
      result.bands.begin(), result.bands.end(),
      [](const ReactionBand& a, const ReactionBand& b) { return a.half_width < b.half_width; });
  const ChannelLayout layout(model.base().pump);
  return text + fmt::format("; reactions are known {}to {:.2g} % ({}) .. {:.2g} % ({}) of peak",
                            unsettled(result) ? "roughly (posterior not converged) " : "",
                            100 * best->half_width, layout.channels()[best->column].name,
                            100 * worst->half_width, layout.channels()[worst->column].name);
}

// The unknowns with how well they are known, what the data leave open, and what would help.
std::vector<std::string> answers_of(const DataModel& model, const Identification& result) {
  std::vector<std::string> answers;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    const std::string unit = u.variable.unit().empty() ? "" : " " + u.variable.unit();
    const HeldUnknown* held = held_of(result, i);
    std::string text = fmt::format("{} = {:.6g}{}{} (case: {:.6g}", u.name(), result.fit.x[i], unit,
                                   !held        ? ""
                                   : held->high ? ", its upper bound"
                                                : ", its lower bound",
                                   u.variable.value(model.base()));
    if (held && result.profiles.empty()) {
      // Its standard deviation would be of the bounds.
    } else if (held)
      text += fmt::format("; 95 % within its range: {:.5g} to {:.5g}", result.profiles[i].low,
                          result.profiles[i].high);
    else if (result.goodness.refuted())
      text += fmt::format("; standard deviation {:.3g}, widened", result.information.deviation[i]);
    else if (!result.profiles.empty())
      text +=
          fmt::format("; 95 %: {:.5g}{} to {:.5g}{}", result.profiles[i].low,
                      result.profiles[i].open_low ? ", its bound," : "", result.profiles[i].high,
                      result.profiles[i].open_high ? ", its bound" : "");
    else
      text += fmt::format("; standard deviation {:.3g}", result.information.deviation[i]);
    answers.push_back(text + ").");
  }
  for (const HeldUnknown& held : result.held)
    answers.push_back(report::sentence(held_line(model, held)));
  for (const std::string& line : result.information.words)
    answers.push_back(report::sentence(line));
  if (result.goodness.refuted()) {
    if (!result.worst.empty())
      answers.push_back("Largest residual: " + worst_line(model, result, result.worst[0]) + ".");
    answers.push_back(report::sentence(further_text(model, result)));
  }
  if (!result.candidates.empty() && result.held.empty())
    answers.push_back(
        fmt::format("The most useful further measurement is {}: it would narrow the "
                    "bands of the reactions by {:.3g} % on average.",
                    result.candidates[0].output.name, 100 * result.candidates[0].shrinks));
  return answers;
}

}  // namespace

std::string name_of(const DataModel& model, const WorstResidual& worst) {
  if (worst.unknown) return "prior of " + model.data().unknowns[*worst.unknown].name();
  const Datum& datum = model.data().data[*worst.datum];
  std::string name = datum.what;
  if (datum.curve) name += fmt::format(" at {:g} deg", datum.curve->theta_deg[worst.number]);
  if (const std::string at = known_text(model, datum); !at.empty()) name += " (" + at + ")";
  return name;
}

report::Document identify_document(const DataModel& model, const Identification& result,
                                   const report::Lines& program,
                                   const study::CaseDescription& description) {
  report::Document document;
  document.title = "Identification: " + model.base().name;
  document.program = program;
  study::put_description(document, description);
  document.verdict = verdict_of(result, headline_of(model, result));
  document.verdict->answers = answers_of(model, result);
  document.meaning =
      result.goodness.refuted()
          ? "The data refute the model with these unknowns, at the stated uncertainties: either "
            "a parameter that was not unknown is wrong, or the model leaves out an effect, or "
            "uncertainties are stated too small, or the search missed the best fit (--starts). The "
            "identified values fit best, but they do not describe the pump."
          : "Parameters of the model determined from data, assuming that the model is right and "
            "that all other parameters are known. A fit that is not refuted is not a validation: "
            "only data that nothing was fitted to can validate.";
  std::vector<report::Warning> warnings;
  if (result.goodness.uncertainties_too_large())
    warnings.push_back(
        {"Stated uncertainties too large",
         fmt::format("{}: the residuals are smaller than expected from the stated uncertainties. "
                     "Either these are stated too large, and then all intervals are too wide; or "
                     "the data are not independent of each other, as points of a smoothed record",
                     test_text(result.goodness))});
  if (const auto rhat = unsettled(result))
    warnings.push_back(
        {"Posterior not settled",
         fmt::format("R-hat {:.3g}, above {:g}: the chains have not converged, and the bands are "
                     "rough estimates only. More --steps, fewer unknowns or narrower bounds help",
                     *rhat, kSettled)});
  for (const HeldUnknown& held : result.held)
    warnings.push_back({"Unknown at its bound", held_line(model, held)});
  if (!warnings.empty()) report::append(document.warnings, std::move(warnings));
  document.runs = {goodness_section(result), worst_section(model, result)};
  if (result.goodness.refuted()) document.runs->push_back(further_section(model, result));
  append(document.runs,
         std::vector{unknowns_section(model, result), determined_section(model, result),
                     fitted_section(model, result)});
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
  std::string text = report::answers_text(model.base().name, headline_of(model, result),
                                          answers_of(model, result));
  if (result.goodness.refuted()) {
    text += "largest residuals:\n";
    for (std::size_t w = 0; w < std::min(kWorstPrinted, result.worst.size()); ++w)
      text += "  " + worst_line(model, result, result.worst[w]) + "\n";
    text += std::string(kWithheld) + "\n" + birge_text(result.goodness) + "\n";
  }
  if (const auto rhat = unsettled(result))
    text += fmt::format("posterior not converged: R-hat {:.3g}; bands are rough estimates only\n",
                        *rhat);
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

std::string identified_case_text(const DataModel& model, const Identification& result) {
  const GoodnessOfFit& fit = result.goodness;
  Case identified = model.pump(result.fit.x);
  identified.name += fit.refuted() ? ", identified (fit refuted)" : ", identified";
  std::string head = "# Identified values. " + fit_text(fit) + ".\n";
  if (fit.refuted())
    head +=
        "# The data refute this pump: its values fit best, but they do not describe the pump that "
        "was measured.\n";
  for (const HeldUnknown& held : result.held) head += "# " + held_text(model, held) + ".\n";
  return head + case_text(identified);
}

std::string unknowns_csv(const DataModel& model, const Identification& result) {
  std::string text =
      "unknown,unit,low,high,identified,linear_deviation,profile_low,profile_high,q025,q500,q975,"
      "widened_by\n";
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    const Quantiles q = quantiles_of(result.posterior.unknowns, model.size(), i);
    text += u.name() + "," + u.variable.unit();
    for (const double value : {u.low, u.high, result.fit.x[i], result.information.deviation[i],
                               result.profiles.empty() ? not_computed() : result.profiles[i].low,
                               result.profiles.empty() ? not_computed() : result.profiles[i].high,
                               q.low, q.middle, q.high, widened_by(result)})
      text += is_computed(value) ? fmt::format(",{}", value) : ",";
    text += "\n";
  }
  return text;
}

std::string bands_csv(const DataModel& model, const Identification& result) {
  if (result.bands.empty()) return "";
  const ChannelLayout layout(model.base().pump);
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

#include "bentaxis/designs/identify_document.h"

#include "bentaxis/files/case_writer.h"
#include "bentaxis/results/channels.h"
#include "document_parts.h"
#include "identify_goodness.h"

namespace bentaxis::designs {
namespace {

using report::NewSection;
using report::Section;

// Largest R-hat of walkers that have settled (Vehtari et al. 2021 ask for 1.01 of long chains).
constexpr double kSettled = 1.1;
constexpr std::size_t kWorstPrinted = 5;

// The largest R-hat of walkers that have not settled.
std::optional<double> unsettled(const Identification& result) {
  const auto& rhat = result.posterior.rhat;
  if (result.posterior.count == 0 || rhat.empty()) return std::nullopt;
  const double largest = *std::ranges::max_element(rhat);
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
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.025), at(0.5), at(0.975)};
}

// The model's number for a datum, of its range both.
std::string number_text(const Datum& datum, double low, double high) {
  if (datum.curve || !is_computed(low)) return "";
  return low == high ? fmt::format("{:.6g}", low) : fmt::format("{:.5g} to {:.5g}", low, high);
}

double worst_residual(const Identification& result, std::size_t datum) {
  const auto worst = std::ranges::find(result.worst, datum, &WorstResidual::datum);
  return worst == result.worst.end() ? 0 : worst->residual;
}

// ---- Unknowns at a bound

const HeldUnknown* held_of(const Identification& result, std::size_t unknown) {
  const auto at = std::ranges::find(result.held, unknown, &HeldUnknown::unknown);
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
  return joined(result.held, ", ", [&](const HeldUnknown& held) {
    return model.data().unknowns[held.unknown].name();
  });
}

// What is not known because of them.
std::string only_within(const DataModel& model, const Identification& result) {
  return "They hold only if the bound is right at which this ends: " + held_names(model, result) +
         ".";
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
  NewSection section(
      "Unknowns",
      "Identified: minimum of the sum of squares. Linear: standard uncertainty of a linearised "
      "model with bounds as normal priors. Profile: 95 % limits, at which the sum of squares has "
      "increased by 3.841 with the other unknowns fitted again; a limit at a bound follows from "
      "the bound, not from the data. Posterior: 95 % of the draws. All of them are right only "
      "where the stated uncertainties are right: a rise of 3.841 means 95 % for that noise alone.");
  if (result.goodness.refuted()) {
    section.fact("withheld", kWithheld);
    section.fact("widened", birge_text(result.goodness));
  }
  section.columns("unknown", "unit", "bounds", "identified", "linear", "profile from", "profile to",
                  "open at a bound", "2.5 % from", "97.5 % to", "share of bounds left", "ends at");
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    const Quantiles q = quantiles_of(result.posterior.unknowns, model.size(), i);
    const HeldUnknown* held = held_of(result, i);
    report::Row profile(3);
    if (!result.profiles.empty()) {
      const Profile& p = result.profiles[i];
      profile = report::row_of(p.low, p.high,
                               p.open_low && p.open_high ? "both"
                               : p.open_low              ? "low"
                               : p.open_high             ? "high"
                                                         : "");
    }
    section.row(u.name(), u.variable.unit(), fmt::format("{:g} to {:g}", u.low, u.high),
                result.fit.x[i], result.information.deviation[i], profile, q.low, q.high,
                (q.high - q.low) / (u.high - u.low),
                held == nullptr ? ""
                : held->high    ? "its upper bound"
                                : "its lower bound");
  }
  return section;
}

Section determined_section(const DataModel& model, const Identification& result) {
  constexpr double kNamed = 0.2;  // weight of an unknown
  NewSection section(
      "What the data determine",
      "From the derivatives of the fitted data at the solution. A window that is met has no "
      "derivative there, although it limits the range: profiles and posterior take it into "
      "account.");
  for (const HeldUnknown& held : result.held) section.fact("", held_line(model, held));
  for (const std::string& line : result.information.words) section.fact("", line);
  section.columns("direction", "times narrower than the bounds", "mostly along");
  for (std::size_t d = 0; d < result.information.directions.size(); ++d) {
    const Direction& direction = result.information.directions[d];
    const auto size = [&](std::size_t i) { return std::abs(direction.weights[i]); };
    auto along = report::by_size(direction.weights.size(), size);
    std::erase_if(along, [&](std::size_t i) { return !(size(i) > kNamed); });
    section.row(d + 1, direction.strength, joined(along, ", ", [&](std::size_t i) {
                  return fmt::format("{:+.2f} {}", direction.weights[i],
                                     model.data().unknowns[i].name());
                }));
  }
  return section;
}

// What is said of every datum: where it is from, what is given, what the model says.
const std::vector<std::string> kDatumColumns = {"datum", "where", "at", "unit", "given", "model"};

report::Row datum_cells(const DataModel& model, const Identification& result, std::size_t i) {
  const Datum& datum = model.data().data[i];
  const std::size_t place = model.place_of(i);
  return report::row_of(
      datum.what, datum.where, known_text(model, datum), datum.unit, given_text(datum),
      number_text(datum, result.numbers[place], result.numbers[place + datum.size() - 1]));
}

Section fitted_section(const DataModel& model, const Identification& result) {
  NewSection section(
      "Data that unknowns are fitted to",
      std::string("Residual: model minus datum over its standard uncertainty, 0 inside a window. "
                  "Leave-one-out: prediction from the other data, with bounds as normal priors, "
                  "and its error over the combined standard uncertainty of prediction and datum") +
          (result.goodness.refuted()
               ? ", both as stated: as the fit is refuted, they are too small."
               : "."));
  section.columns(kDatumColumns, "residual", "left out: predicted", "+-", "off by");
  for (std::size_t i = 0; i < model.data().data.size(); ++i) {
    const Datum& datum = model.data().data[i];
    if (datum.use != Use::fitted) continue;
    report::Row prediction;
    if (const auto left = std::ranges::find(result.left_out, i, &LeftOut::datum);
        left != result.left_out.end())
      prediction = report::row_of(number_text(datum, left->value, left->high), left->deviation,
                                  left->distance);
    section.row(datum_cells(model, result, i), worst_residual(result, i), prediction);
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
  NewSection section("Data that are predicted",
                     "Nothing was fitted to them. Band: 95 % of the posterior; of a range its "
                     "ends.");
  section.columns(kDatumColumns, "2.5 % from", "97.5 % to", "the band meets it");
  for (std::size_t i = 0; i < model.data().data.size(); ++i) {
    if (model.data().data[i].use != Use::predicted) continue;
    report::Row in_band;
    if (const auto band = predicted_band(model, result, i))
      in_band = report::row_of(band->low, band->high, band->meets ? "yes" : "no");
    section.row(datum_cells(model, result, i), in_band);
  }
  return section;
}

Section left_out_section(const DataModel& model) {
  NewSection section("Data that are left out");
  section.columns("datum", "where", "why");
  for (const Datum& datum : model.data().data)
    if (datum.use == Use::left_out) section.row(datum.what, datum.where, datum.reason);
  return section;
}

Section reactions_section(const DataModel& model, const Identification& result) {
  const ChannelLayout layout(model.base().pump);
  NewSection section(
      "Uncertainty of each reaction",
      "Half the width of the 95 % band where it is widest, of the peak of its middle curve, at the "
      "case's own speed and pressure. All other parameters are taken as known.");
  if (!result.held.empty()) section.fact("", only_within(model, result));
  section.columns("reaction", "half width, % of peak");
  for (const ReactionBand& band : result.bands)
    section.row(layout.channels()[band.column].name, 100 * band.half_width);
  return section;
}

const char* measured_text(Measured measured) {
  switch (measured) {
    case Measured::on_a_rig:
      return "the torque meter of a test rig measures it";
    case Measured::at_bearings:
      return "force sensors in the seats of the shaft's bearings measure it";
    case Measured::nowhere:
      break;
  }
  return "no test rig measures it";
}

Section candidates_section(const Identification& result) {
  constexpr std::size_t kShown = 12;
  Section section;
  section.title = "Most useful further measurements";
  section.text =
      "By how much the bands would become narrower, mean over the reactions, if that number were "
      "measured too: linear, from the covariances of the draws. What every test rig measures comes "
      "first, then what force sensors at the bearings do, then forces that only a model gives.";
  section.table.columns = {
      "measurement", "measured to, standard", "unit",         "all bands narrower by, %",
      "most",        "that one by, %",        "on a test rig"};
  for (std::size_t c = 0; c < std::min(kShown, result.candidates.size()); ++c) {
    const Candidate& k = result.candidates[c];
    section.table.rows.push_back({k.output.name, k.deviation, k.output.unit, 100 * k.shrinks,
                                  k.most, 100 * k.most_shrinks,
                                  std::string(measured_text(k.measured))});
  }
  return section;
}

Section search_section(const DataModel& model, const Identification& result) {
  NewSection section("Search");
  section.fact("least squares", least_squares_library());
  section.fact("sum of squares", "{:.4g}", result.fit.sum_of_squares);
  section.fact("residuals", std::to_string(result.fit.residuals.size()));
  section.fact("unknowns", std::to_string(model.size()));
  if (result.posterior.count > 0) {
    const auto& p = result.posterior;
    section.fact("moves accepted", "{:.0f} %", 100 * p.accepted);
    section.fact("independent draws, of the worst unknown",
                 unsettled(result) ? "not determined: the chains have not converged"
                                   : fmt::format("{:.0f}", p.effective));
    section.fact("largest R-hat", "{:.3f}", std::ranges::max(p.rhat));
  }
  section.columns("minimum", "sum of squares", "starts that led there");
  for (std::size_t m = 0; m < result.minima.size(); ++m)
    section.row(m + 1, result.minima[m].sum_of_squares, result.minima[m].starts);
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
      figures.push_back(
          {"band_" + channel.name, channel.name + ": what the data do not determine", "",
           report::BandFigure{{"shaft angle", "deg"},
                              {channel.quantity + " " + channel.axis, channel.unit},
                              true,
                              result.theta_deg,
                              {{"95 % of the posterior", band.low, band.middle, band.high}}}});
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
  const auto unknowns = static_cast<int>(model.size());
  if (result.held.empty() && open == unknowns)
    text = fmt::format(
        "the data determine none of the unknowns: none of {} directions becomes less than half as "
        "wide as the bounds, and the identified values follow from the case and the bounds; {}",
        unknowns, text);
  else if (result.held.empty())
    text += fmt::format("; {} of {} directions become less than half as wide as the bounds",
                        unknowns - open, unknowns);
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
  const auto [best, worst] = std::ranges::minmax_element(
      result.bands,
      [](const ReactionBand& a, const ReactionBand& b) { return a.half_width < b.half_width; });
  const ChannelLayout layout(model.base().pump);
  return text + fmt::format("; reactions are known {}to {:.2g} % ({}) .. {:.2g} % ({}) of peak",
                            unsettled(result) ? "roughly (posterior not converged) " : "",
                            100 * best->half_width, layout.channels()[best->column].name,
                            100 * worst->half_width, layout.channels()[worst->column].name);
}

// The best measurement that every rig makes, and that of sensors which a rig may have where they
// would give more.
std::string measurement_text(const Identification& result) {
  const Candidate& first = result.candidates.front();
  std::string text = fmt::format(
      "The most useful further measurement is {}: {}. It would narrow the bands of the "
      "reactions by {:.3g} % on average",
      first.output.name, measured_text(first.measured), 100 * first.shrinks);
  const auto other =
      std::find_if(result.candidates.begin(), result.candidates.end(),
                   [&](const Candidate& c) { return c.measured == Measured::at_bearings; });
  if (first.measured == Measured::on_a_rig && other != result.candidates.end() &&
      other->shrinks > first.shrinks)
    text += fmt::format("; {} by {:.3g} % ({})", other->output.name, 100 * other->shrinks,
                        measured_text(other->measured));
  return text + ".";
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
    answers.push_back(measurement_text(result));
  return answers;
}

std::vector<report::Warning> warnings_of(const DataModel& model, const Identification& result) {
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
  return warnings;
}

}  // namespace

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
  if (auto warnings = warnings_of(model, result); !warnings.empty())
    report::append(document.warnings, std::move(warnings));
  document.runs = {goodness_section(result), worst_section(model, result)};
  if (result.goodness.refuted()) document.runs->push_back(further_section(model, result));
  append(document.runs,
         std::vector{unknowns_section(model, result), determined_section(model, result),
                     fitted_section(model, result), predicted_section(model, result),
                     left_out_section(model)});
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

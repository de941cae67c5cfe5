#include "identify_goodness.h"

#include "bentaxis/designs/identify_document.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

constexpr std::size_t kWorstShown = 10, kFurtherShown = 5;

std::string chi_square_text(double value) {
  return value < 1e4 || value > 1e15 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}
std::string p_text(double p) {
  return p < 1e-300 ? "p below 1e-300" : fmt::format("p = {:.2g}", p);
}

// Given and model of a worst residual with their unit; of a prior its distribution and the unknown.
struct WorstValues {
  std::string given, of_model, unit;
};
WorstValues worst_values(const DataModel& model, const Identification& result,
                         const WorstResidual& worst) {
  if (worst.unknown) {
    const Unknown& u = model.data().unknowns[*worst.unknown];
    return {u.prior->text(), fmt::format("{:.6g}", result.fit.x[*worst.unknown]),
            u.variable.unit()};
  }
  const Datum& datum = model.data().data[*worst.datum];
  const double of_model = result.numbers[model.place_of(*worst.datum) + worst.number];
  const std::string given = datum.curve
                                ? fmt::format("{:.6g} +- {:g}", datum.curve->values[worst.number],
                                              rounded(datum.curve->uncertainties[worst.number], 2))
                                : given_text(datum);
  return {given, fmt::format("{:.6g}", of_model), datum.unit};
}

// "friction.piston_coulomb_N (119.8 N instead of 0): chi-square .."
std::string further_line(const DataModel& model, const FurtherUnknown& f) {
  std::string text =
      fmt::format("{} ({:.6g}{} instead of {:g}): {} would remain", f.variable.name(), f.value,
                  unit_after(f.variable.unit()), f.before, test_text(f.fit));
  if (f.fit.refuted()) text += ", still refuted";
  if (!model.base().analytic.piston_friction && f.variable.name().starts_with("friction.piston_"))
    text += "; it acts with piston_friction = true of [assumptions.analytic] only";
  if (!f.implausible.empty()) text += "; the value is implausible: " + joined(f.implausible);
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

}  // namespace

std::string known_text(const DataModel& model, const Datum& datum) {
  std::string at = model.data().conditions[datum.condition].name;
  if (!datum.variant.empty()) at += (at.empty() ? "" : "; ") + datum.variant;
  return at;
}

std::string given_text(const Datum& datum) {
  if (datum.curve)
    return fmt::format("{} points +- {:.3g}", datum.curve->values.size(), datum.uncertainty);
  if (datum.value)
    return fmt::format("{:.6g} +- {:g}", *datum.value, rounded(datum.uncertainty, 2));
  if (!std::isfinite(datum.low)) return fmt::format("below {:g}", datum.high);
  if (!std::isfinite(datum.high)) return fmt::format("above {:g}", datum.low);
  return fmt::format("{:g} to {:g}", datum.low, datum.high);
}

std::string test_text(const GoodnessOfFit& fit) {
  std::string text = fmt::format("chi-square {} with {} degrees of freedom",
                                 chi_square_text(fit.chi_square), fit.degrees_of_freedom());
  return fit.p_value ? text + ", " + p_text(*fit.p_value) : text;
}

std::string fit_text(const GoodnessOfFit& fit) {
  const std::string test = test_text(fit);
  if (fit.refuted())
    return "the model does not fit the data: " + test +
           (fit.p_value ? fmt::format(" (refuted below {:g})", kFitRefutedBelow)
                        : ", where a fit passes through all data");
  if (!fit.p_value) return "no test of the fit: " + test;
  return "fit: " + test + ": not refuted" +
         (fit.uncertainties_too_large()
              ? "; residuals are smaller than expected from the stated uncertainties"
              : "");
}

std::string birge_text(const GoodnessOfFit& fit) {
  return fmt::format(
      "Linear standard deviations are widened: they hold for data with all stated uncertainties "
      "multiplied by {:.3g}, the root of chi-square over the degrees of freedom (Birge ratio). "
      "This accounts for uncertainties that were stated too small. It does not account for a wrong "
      "model: true values can lie outside.",
      fit.birge_ratio());
}

std::string worst_line(const DataModel& model, const Identification& result,
                       const WorstResidual& worst) {
  const auto [given, of_model, unit] = worst_values(model, result, worst);
  return fmt::format("{}: {:+.1f} sigma (data {}, model {}{})", name_of(model, worst),
                     worst.residual, given, of_model, unit_after(unit));
}

std::string further_text(const DataModel& model, const Identification& result) {
  if (result.further.empty()) return "no single further parameter of the case improves the fit";
  std::string text = "the further unknown that would improve the fit most: " +
                     further_line(model, result.further.front());
  if (const auto names = as_good_as_best(result); !names.empty())
    text += ". The data do not distinguish it from " + joined(names);
  return text;
}

std::string name_of(const DataModel& model, const WorstResidual& worst) {
  if (worst.unknown) return "prior of " + model.data().unknowns[*worst.unknown].name();
  const Datum& datum = model.data().data[*worst.datum];
  std::string name = datum.what;
  if (datum.curve) name += fmt::format(" at {:g} deg", datum.curve->theta_deg[worst.number]);
  if (const std::string at = known_text(model, datum); !at.empty()) name += " (" + at + ")";
  return name;
}

report::Section goodness_section(const Identification& result) {
  const GoodnessOfFit& fit = result.goodness;
  report::NewSection section(
      "Goodness of fit",
      "Chi-square: sum of the squared residuals, each over its standard uncertainty. p: "
      "probability of a larger chi-square if the model and all stated uncertainties are right and "
      "the data are independent of each other. The degrees of freedom are the data that count "
      "(values, points of curves, priors, windows that the fit leaves) less the directions of the "
      "unknowns that were fitted to them.");
  section.fact("result", fit_text(fit));
  if (!fit.p_value)
    section.fact("no test",
                 "There are as many fitted unknowns as data: the model cannot be tested.");
  if (fit.refuted()) {
    section.fact("withheld", kWithheld);
    section.fact("widened", birge_text(fit));
  }
  section.columns("chi-square", "data that count", "fitted directions", "degrees of freedom",
                  "p-value", "refuted below", "refuted", "Birge ratio");
  section.row(fit.chi_square, fit.residuals, fit.fitted_directions, fit.degrees_of_freedom(),
              fit.p_value, kFitRefutedBelow, fit.refuted(),
              fit.p_value ? fit.birge_ratio() : not_computed());
  return section;
}

report::Section worst_section(const DataModel& model, const Identification& result) {
  report::NewSection section(
      "Largest residuals",
      "Residual: model minus datum over its standard uncertainty (sigma); of a curve the worst "
      "point. Share of chi-square: of all points of the curve.");
  section.columns("datum", "unit", "given", "model", "residual, sigma", "share of chi-square, %");
  for (std::size_t w = 0; w < std::min(kWorstShown, result.worst.size()); ++w) {
    const WorstResidual& worst = result.worst[w];
    const auto [given, of_model, unit] = worst_values(model, result, worst);
    section.row(name_of(model, worst), unit, given, of_model, worst.residual, 100 * worst.share);
  }
  return section;
}

report::Section further_section(const DataModel& model, const Identification& result) {
  report::NewSection section(
      "Which further unknown would improve the fit most",
      "All continuous parameters that are active in the case and not unknown were compared by the "
      "derivatives of the residuals. The most promising ones were each fitted together with the "
      "unknowns. A better fit does not prove that this parameter is wrong: several can have the "
      "same effect on the data.");
  section.fact("result", further_text(model, result));
  section.columns("parameter", "unit", "in the case", "fitted", "chi-square", "degrees of freedom",
                  "p-value", "refuted", "implausible");
  for (std::size_t k = 0; k < std::min(kFurtherShown, result.further.size()); ++k) {
    const FurtherUnknown& f = result.further[k];
    section.row(f.variable.name(), f.variable.unit(), f.before, f.value, f.fit.chi_square,
                f.fit.degrees_of_freedom(), f.fit.p_value, f.fit.refuted(), joined(f.implausible));
  }
  return section;
}

}  // namespace bentaxis::designs

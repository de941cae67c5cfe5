#include "bentaxis/designs/sensitivity_document.h"

#include "bentaxis/designs/independence.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

using report::Cell;
using report::NewSection;
using report::Section;

constexpr std::size_t kBars = 20;       // of a figure, at most,
constexpr double kShortestBar = 1e-3;   // of the longest
constexpr double kNoInfluence = 1e-12;  // of the output's scale: round-off
constexpr double kRoundOff = 1e-9;      // error of an exact derivative over it: no kink
constexpr std::size_t kTextLines = 8;   // of an output

// What one percent of a variable changes in an output.
double effect(const Sensitivities& s, std::size_t o, std::size_t v) {
  return s.derivatives[o][v].value * s.at[v] / 100;
}

// Whether all that there is of a derivative is round-off.
bool no_influence(const Sensitivities& s, std::size_t o, std::size_t v) {
  const double size = s.at[v] == 0 ? 1 : std::abs(s.at[v]);
  return std::abs(s.derivatives[o][v].value) * size <= kNoInfluence * s.scales[o];
}

// Variables by what one percent of them changes, most first; what has no derivative last.
std::vector<std::size_t> by_effect(const Sensitivities& s, std::size_t o) {
  return report::by_size(s.variables.size(),
                         [&](std::size_t v) { return std::abs(effect(s, o, v)); });
}

std::string per(const std::string& unit, const std::string& by) {
  std::string above = unit.empty() ? "1" : unit;
  if (by.empty()) return above;
  return above + "/" + (by.find('/') == std::string::npos ? by : "(" + by + ")");
}

Section outputs_section(const Sensitivities& s) {
  NewSection section("Outputs");
  section.columns("output", "value", "unit", "meaning");
  for (std::size_t o = 0; o < s.outputs.size(); ++o)
    section.row(s.outputs[o].name, s.values[o], s.outputs[o].unit, s.outputs[o].meaning);
  return section;
}

std::string found_by(const Derivative& d) { return d.reason.empty() ? to_string(d.way) : d.reason; }

// Of these the case says nothing: a parameter that they take their value from moves them as well,
// so that the same edge, say, has a row of its own under either name.
std::string followers_text(const Sensitivities& s) {
  std::vector<std::string> names;
  const Family family(s.base, {});
  for (const Family::Follower& follower : family.followers()) {
    const std::string name = follower.table->name + "." + follower.parameter->key;
    if (std::ranges::any_of(s.variables, [&](const Variable& v) {
          return v.name() == name || v.name() == name + ".1" || v.name() == name + ".2";
        }))
      names.push_back(name);
  }
  if (names.empty()) return {};
  return "The case does not give " + joined(names) +
         ": the value is that of another parameter. The row of that parameter changes both, the "
         "row of these changes them alone; do not add the two.";
}

Section derivatives_section(const Sensitivities& s, std::size_t o) {
  const Output& output = s.outputs[o];
  NewSection section("Derivatives of " + output.name);
  section.columns("parameter", "value", "unit", "derivative", "of unit",
                  "by +1 % (" + output.unit + ")", "elasticity (%/%)", "found by",
                  "error of the derivative");
  std::vector<std::string> none;
  for (const std::size_t v : by_effect(s, o)) {
    const Derivative& d = s.derivatives[o][v];
    const Variable& variable = s.variables[v];
    if (no_influence(s, o, v)) {
      none.push_back(variable.name());
      continue;
    }
    const bool exact = d.way == Way::exact && d.error <= kRoundOff * std::abs(d.value);
    section.row(variable.name(), s.at[v], variable.unit(), d.value,
                per(output.unit, variable.unit()), effect(s, o, v), s.elasticity(o, v), found_by(d),
                exact ? Cell("round-off") : Cell(d.error));
  }
  if (!none.empty()) section.say("No influence: " + joined(none) + ".");
  if (const std::string text = followers_text(s); !text.empty()) section.say(text);
  return section;
}

report::Figure tornado(const Sensitivities& s, std::size_t o) {
  const Output& output = s.outputs[o];
  report::BarsFigure bars{{"change of " + output.name + " by +1 % of the parameter", output.unit},
                          {}};
  double longest = 0;
  for (const std::size_t v : by_effect(s, o)) {
    const double e = effect(s, o, v);
    if (bars.bars.empty()) longest = std::abs(e);
    if (bars.bars.size() == kBars || !(std::abs(e) > kShortestBar * longest)) break;
    bars.bars.push_back({s.variables[v].name(), std::min(e, 0.0), std::max(e, 0.0),
                         fmt::format("{} {}, elasticity {:.4g}", s.variables[v].text(s.at[v]),
                                     s.variables[v].unit(), s.elasticity(o, v))});
  }
  return {fmt::format("tornado_{}", o + 1), "What moves " + output.name, "", std::move(bars)};
}

std::size_t derivatives_by(const Sensitivities& s, Way way) {
  std::size_t count = 0;
  for (const auto& row : s.derivatives)
    count += report::count_of(
        row, [&](const Derivative& d) { return d.way == way && is_computed(d.value); });
  return count;
}

std::string other_model(const SensitivityCheck& check) {
  return check.other.model == study::Model::multibody ? "Simbody" : "the closed form";
}

std::string headline(const Sensitivities& s, const std::optional<SensitivityCheck>& check) {
  if (!check)
    return fmt::format(
        "{}{} derivatives {}, {} by differences", s.left_out.empty() ? "" : "Interrupted: ",
        derivatives_by(s, Way::exact) + derivatives_by(s, Way::forward),
        s.base.pressure.kind == PressureKind::hydraulic ? "by forward sensitivities" : "exact",
        derivatives_by(s, Way::differences));
  if (check->compared == 0 || check->lacking > 0)
    return fmt::format("{} of {} derivatives could be compared; of {} one model alone has a value",
                       check->compared, s.outputs.size() * s.variables.size(), check->lacking);
  const std::string worst = check->worst > 0
                                ? fmt::format(" ({} by {})", s.outputs[check->output].name,
                                              s.variables[check->variable].name())
                                : "";
  const std::size_t all = s.outputs.size() * s.variables.size();
  if (check->compared == 0 || check->lacking > 0)
    return fmt::format("{} of {} derivatives could be compared; of {} one model alone has a value",
                       check->compared, all, check->lacking);
  return fmt::format(
      "{}derivatives {} differences of {}: largest difference {:.2g} of the output's scale per "
      "relative change{}, allowed {:g}",
      check->compared < all ? fmt::format("{} of {} ", check->compared, all) : "",
      check->agrees() ? "agree with" : "differ from", other_model(*check), check->worst, worst,
      SensitivityCheck::kTolerance);
}

// Which derivatives were not checked, and why.
report::Lines not_checked(const Sensitivities& s, const SensitivityCheck& check) {
  report::Lines lines;
  for (const std::string& output : not_independent(s.outputs, s.base))
    lines.emplace_back("not checked", output);
  if (check.missing > 0)
    lines.emplace_back(
        "not compared",
        fmt::format("{}: one model has none, or its differences are less accurate", check.missing));
  return lines;
}

// By how many percent each output changes per percent of a parameter.
std::vector<std::string> answers_of(const Sensitivities& s,
                                    const std::optional<SensitivityCheck>& check) {
  constexpr double kSmall = 0.1;  // %/%
  constexpr std::size_t kNamed = 4;
  std::vector<std::string> answers;
  if (!s.left_out.empty()) answers.push_back(left_out_text(s));
  for (std::size_t o = 0; o < s.outputs.size(); ++o) {
    std::string largest;
    std::size_t named = 0, more = 0, small = 0;
    for (const std::size_t v : by_effect(s, o)) {
      const double share = no_influence(s, o, v) ? 0 : s.elasticity(o, v);
      if (!is_computed(share)) continue;
      if (std::abs(share) < kSmall) {
        ++small;
      } else if (named == kNamed) {
        ++more;
      } else {
        largest += fmt::format("{}{:+.3g} % {} {}", named == 0 ? " " : ", ", share,
                               named == 0 ? "per % of" : "of", s.variables[v].name());
        ++named;
      }
    }
    if (named + small == 0) continue;
    answers.push_back(s.outputs[o].name + ":" + largest +
                      (more > 0 ? fmt::format(", {} more", more) : "") +
                      (named == 0 ? fmt::format(" no parameter changes it by {:g} % per %", kSmall)
                                  : fmt::format("; {} others below {:g} %", small, kSmall)) +
                      ".");
  }
  if (check)
    if (const auto shared = not_independent(s.outputs, s.base); !shared.empty())
      answers.push_back("Not checked by the other model: " + report::joined(shared) + ".");
  return answers;
}

Section check_section(const Sensitivities& s, const SensitivityCheck& check) {
  NewSection section(
      "Against " + other_model(check),
      "Central differences of the other model, extrapolated to no step. The difference of both "
      "derivatives is taken times the parameter's value and over the output's scale, the peak of "
      "its curve over the turn.");
  section.columns("output", "parameter", "derivative", "by the other model", "its error",
                  "difference");
  for (const auto& [name, text] : not_checked(s, check)) section.fact(name, text);
  for (std::size_t o = 0; o < s.outputs.size(); ++o)
    for (std::size_t v = 0; v < s.variables.size(); ++v)
      section.row(s.outputs[o].name, s.variables[v].name(), s.derivatives[o][v].value,
                  check.other.derivatives[o][v].value, check.other.derivatives[o][v].error,
                  check.differences[o][v]);
  return section;
}

}  // namespace

std::string left_out_text(const Sensitivities& s) {
  return fmt::format(
      "Interrupted: {} of {} parameters are missing, and may matter more than those "
      "that are here: {}.",
      s.left_out.size(), s.variables.size(), report::joined(s.left_out));
}

report::Document sensitivity_document(const Sensitivities& found,
                                      const std::optional<SensitivityCheck>& check,
                                      const report::Lines& program,
                                      const study::CaseDescription& description) {
  report::Document document =
      study::case_document(description, "Sensitivities: " + found.base.name, program);
  document.verdict = {.agrees = check ? std::optional<bool>(check->agrees()) : std::nullopt,
                      .headline = headline(found, check),
                      .word = check ? "" : "Sensitivities",
                      .answers = answers_of(found, check)};
  if (!found.left_out.empty())
    report::append(document.warnings, report::Warning{"interrupted", left_out_text(found)});
  document.meaning =
      "A derivative is valid for small changes of one parameter with the others constant. An exact "
      "derivative is accurate to round-off; one by differences has its error beside it. The "
      "derivative of a maximum or minimum is that at its sample; where several samples attain it, "
      "it is the mean of the one-sided derivatives, and its error is their half difference.";
  if (found.base.pressure.kind == PressureKind::hydraulic)
    document.meaning +=
        " The pressure is that of a periodic state: each difference compares two such states.";
  document.runs = {outputs_section(found)};
  document.figures.emplace();
  for (std::size_t o = 0; o < found.outputs.size(); ++o) {
    document.runs->push_back(derivatives_section(found, o));
    document.figures->push_back(tornado(found, o));
  }
  if (check) document.runs->push_back(check_section(found, *check));
  return document;
}

std::string sensitivity_csv(const Sensitivities& found,
                            const std::optional<SensitivityCheck>& check) {
  CsvRows csv(
      std::string("output,output_unit,output_value,parameter,parameter_unit,parameter_value,"
                  "derivative,elasticity,found_by,error") +
      (check ? ",derivative_of_other_model,difference" : "") + ",reason");
  for (std::size_t o = 0; o < found.outputs.size(); ++o)
    for (std::size_t v = 0; v < found.variables.size(); ++v) {
      const Derivative& d = found.derivatives[o][v];
      std::vector<double> other;
      if (check) other = {check->other.derivatives[o][v].value, check->differences[o][v]};
      csv.row(found.outputs[o].name, found.outputs[o].unit, found.values[o],
              found.variables[v].name(), found.variables[v].unit(), found.at[v], d.value,
              found.elasticity(o, v), is_computed(d.value) ? to_string(d.way) : "", d.error, other,
              d.reason);
    }
  return std::move(csv).text();
}

std::string sensitivity_text(const Sensitivities& found,
                             const std::optional<SensitivityCheck>& check) {
  const auto number = [](double value) {
    return is_computed(value) ? fmt::format("{:.6g}", value) : std::string("-");
  };
  std::string text =
      report::answers_text(found.base.name, headline(found, check), answers_of(found, check));
  text.pop_back();
  for (std::size_t o = 0; o < found.outputs.size(); ++o) {
    text += fmt::format("\n{} = {:.7g} {}\n{:<34} {:>12} {:>13} {:>12}  {}\n",
                        found.outputs[o].name, found.values[o], found.outputs[o].unit, "parameter",
                        "value", "derivative", "%/%", "found by");
    const auto order = by_effect(found, o);
    for (std::size_t i = 0; i < std::min(kTextLines, order.size()); ++i) {
      const std::size_t v = order[i];
      const Derivative& d = found.derivatives[o][v];
      const bool none = no_influence(found, o, v);
      text += fmt::format("{:<34} {:>12} {:>13} {:>12}  {}\n", found.variables[v].name(),
                          number(found.at[v]), none ? "0" : number(d.value),
                          none ? "-" : number(found.elasticity(o, v)), found_by(d));
    }
    if (order.size() > kTextLines)
      text += fmt::format("and {} more in sensitivity.csv\n", order.size() - kTextLines);
  }
  if (const std::string followers = followers_text(found); !followers.empty())
    text += "\n" + followers + "\n";
  return text;
}

}  // namespace bentaxis::designs

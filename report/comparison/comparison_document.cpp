#include "bentaxis/study/comparison_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "answers_text.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/report/text.h"
#include "bentaxis/study/budget_section.h"
#include "bentaxis/study/calibration.h"
#include "bentaxis/study/comparison_answers.h"
#include "bentaxis/study/engine_comparison.h"
#include "bentaxis/study/force_figures.h"
#include "bentaxis/study/pump_scene.h"
#include "bentaxis/study/reference_curves.h"
#include "bentaxis/study/regression_document.h"
#include "bentaxis/study/teeth_section.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/turn_summary.h"
#include "comparison_figures.h"
#include "document_parts.h"
#include "hydraulic_sections.h"
#include "key_figures.h"

namespace bentaxis::study {
namespace {

// Where no pump behaves as computed: "over 7.5 % of the turn"; of two pumps, which.
std::string not_valid_of(const ComparisonResult& r) {
  std::string text = not_valid_text(r.limits);
  if (!r.other) return text;
  const auto of = [&](const std::string& share, Model model) {
    return share.empty() ? "" : share + " of " + r.pump_of(model);
  };
  text = of(text, Model::analytic);
  const std::string second = of(not_valid_text(r.other->limits), Model::multibody);
  return text + (text.empty() || second.empty() ? "" : "; ") + second;
}

report::Verdict verdict_of(const ComparisonResult& r) {
  report::Verdict verdict{r.passes(), r.headline()};
  verdict.answers = comparison_answers(r);
  verdict.not_valid = not_valid_of(r);
  if (r.agrees() && !r.split && only_one_computed(r.comparison)) verdict.word = "Agrees in part";
  if (r.with) {
    verdict.models_agree = r.agrees();
    if (r.agrees_but_for_reference()) {
      const bool differs = r.with->differs();
      verdict.word = differs ? "Reference differs" : "Reference incomplete";
      verdict.headline += (differs ? " They differ from " + r.with->name
                                   : " The reference " + r.with->name + " is incomplete") +
                          ": " + held_text(*r.with);
    }
  }
  if (r.engines && r.agrees() && !r.engines->agrees()) {
    verdict.models_agree = true;
    verdict.word = "An engine differs";
    verdict.headline = r.engines->headline() + " " + verdict.headline;
  }
  if (const auto cause = r.cause())
    verdict.cause = {cause->text, cause->round_off, cause->over_scale};
  verdict.tolerance = r.tolerance;
  verdict.compared = r.comparison.compared();
  verdict.checks_hold = r.checks_hold();
  if (const auto* worst = r.comparison.worst()) {
    verdict.digits = worst->digits;
    verdict.worst = {worst->channel.name, worst->largest_over_peak(), worst->theta_of_largest_deg};
  }
  if (r.split) {
    if (verdict.word.empty()) verdict.word = r.agrees() ? "Explained" : "Not explained";
    verdict.rest_over_peak = r.split->largest_rest();
    verdict.rest_tolerance = r.split->tolerance;
  }
  return verdict;
}

report::KeyFigures key_figures_of(const ComparisonResult& r, const report::Document& document) {
  report::KeyFigures key{
      {r.analytic.name, r.multibody.name}, "deg", turn_figures({&r.analytic, &r.multibody})};
  const auto add = [&](report::KeyFigures::Row row) { key.rows.push_back(std::move(row)); };
  for (auto& row : transfer_figures({&r.analytic, &r.multibody}, r.first.the_case.pump))
    add(std::move(row));
  if (document.budget)
    for (const auto& line : document.budget->efficiency)
      if ((line.name == "hydraulic-mechanical" || line.name == "total") &&
          is_computed(line.values.front()))
        add(key_row(line.name + " efficiency", "", line.unit, line.values));
  if (r.first.hydraulics)
    for (auto& row : oil_figures(r.first.hydraulics->summary, key.models.size()))
      add(std::move(row));
  return key;
}

report::Section integration_section(const ComparisonResult& r) {
  report::NewSection section(
      "Integrated run and torque-driven run",
      fmt::format("Integrator {}, {} revolution(s). Errors are the largest difference from the "
                  "analytic model over the peak. In the torque-driven run the shaft is free and "
                  "driven by the analytic Td; its speed error is relative to omega. Facts are of "
                  "the last accuracy.",
                  name_of(r.options.integration.integrator),
                  r.second.the_case.operation.revolutions));
  section.columns("accuracy asked", "error Rs", "error Rc", "error Rb", "error Rcs", "error Td",
                  "constraint error, m", "constraint rate error, m/s", "gear phase, deg",
                  "work lost, J", "torque-driven speed error", "steps", "evaluations");
  for (const IntegrationRow& row : r.integrations) {
    const multibody::WorstErrors& whole = row.record.whole;
    section.row(row.accuracy, row.rs, row.rc, row.bearings, row.rcs, row.td, whole.position_error,
                whole.velocity_error, whole.gear_phase / kRadPerDegree, whole.work_residual,
                row.torque_driven_speed_error, row.record.steps, row.record.evaluations);
  }
  const multibody::IntegrationRecord& last = r.integrations.back().record;
  section.fact("gear phase, worst (block minus shaft)", "{:.2e} deg",
               last.whole.gear_phase / kRadPerDegree);
  section.fact("shaft angle against omega t, worst", "{:.2e} deg",
               last.whole.shaft_angle / kRadPerDegree);
  section.fact("work of loads", "{:.6g} J", last.work_of_loads);
  section.fact("work of the drive", "{:.6g} J", last.work_of_drives);
  section.fact("kinetic energy gained", "{:.3g} J", last.kinetic_energy_gained);
  section.fact("work unaccounted for", "{:.3g} J", last.whole.work_residual);
  if (!r.choice.empty()) section.fact("chosen", r.choice);
  return section;
}

report::Section rounding_section(const std::vector<RoundingLine>& lines) {
  report::NewSection section(
      "Digits lost to round-off",
      "First-order estimate of the analytic model: the effect of one unit in the last place of "
      "every input, and of rounding every operation the other way; shares of the reaction's peak.");
  section.columns("reaction", "inputs", "arithmetic", "digits left", "weakest input", "at, deg");
  for (const RoundingLine& line : lines)
    section.row(line.group, line.inputs, line.arithmetic,
                std::round(-10 * std::log10(std::max(line.total(), 1e-16))) / 10, line.input,
                line.theta_deg);
  return section;
}

std::string digits_text(const EngineCell& cell) {
  if (!cell.difference.known()) return "";
  constexpr double kMostDigits = 16;
  const double share = std::max(cell.difference.share(), std::pow(10, -kMostDigits));
  return fmt::format("{:.1f}{}", -std::log10(share), cell.differs() ? " !" : "");
}

// Results by group of channels: digits of agreement with the analytic model and with the curve.
report::Table engine_table(const EngineComparison& engines) {
  report::NewSection made("");
  made.columns("reaction", "peak", std::vector(engines.results.begin() + 1, engines.results.end()));
  if (!engines.curve.empty())
    made.columns(
        report::each_of(engines.results, [](const auto& name) { return name + ", curve"; }));
  made.columns("largest difference", "at, deg", "stands alone");
  for (const EngineRow& row : engines.rows) {
    std::vector<std::string> digits;
    EngineCell worst;
    for (std::size_t i = 1; i < engines.results.size(); ++i) {
      digits.push_back(digits_text(row.pairs[0][i]));
      if (worst.difference.keep_larger(row.pairs[0][i].difference)) worst = row.pairs[0][i];
    }
    if (!engines.curve.empty())
      for (std::size_t i = 0; i < engines.results.size(); ++i)
        digits.push_back(row.curve.empty() ? "" : digits_text(row.curve[i]));
    made.row(row.group, fmt::format("{:.4g} {}", row.peak, row.unit), digits, worst.channel,
             worst.theta_deg, row.odd);
  }
  return made.table;
}

std::string way_text(const EngineComparison& engines) {
  return engines.way == EngineWay::given
             ? "given motion"
             : fmt::format("integrated, {} steps per turn", engines.steps);
}

std::string time_text(const EngineComparison& engines, const EngineRun& run) {
  return engines.way == EngineWay::given ? fmt::format("{:.2g} s", run.seconds)
                                         : fmt::format("{:.2g} s for a turn", run.turn_seconds);
}

// Time against error of engines that integrate.
report::Section effort_section(const EngineComparison& engines) {
  report::NewSection section(
      "Engines: time against error",
      fmt::format("One turn integrated at constant speed, with default settings and with one "
                  "setting changed at a time. Errors are the largest difference from the analytic "
                  "model over the peak of a reaction, at {} angles. Time is that of the turn, "
                  "without building the model.",
                  engines.sweep_angles));
  section.columns("engine", "steps per turn", "setting", "time, ms", "error Rs", "largest error",
                  "in", "not computed");
  for (const EngineEffort& effort : engines.sweep) {
    const auto number = [&](double value) {
      return effort.failure.empty() ? value : not_computed();
    };
    section.row(effort.engine, static_cast<double>(effort.steps),
                effort.setting.empty() ? "defaults" : effort.setting, number(1000 * effort.seconds),
                number(effort.joints), number(effort.worst), effort.channel, effort.failure);
  }
  return section;
}

report::Section engine_section(const EngineComparison& engines) {
  report::NewSection section(
      "Engines", engines.headline() +
                     " The table has digits of agreement with the analytic model and, in the "
                     "columns named curve, with the stored curve, relative to the peak of a "
                     "reaction. \"!\" marks a difference above the tolerance.");
  if (engines.curve.empty())
    section.say("There is no stored curve of this case.");
  else
    section.say("The stored curve is {}, of 50-digit arithmetic, at {} angles.", engines.curve,
                engines.curve_angles);
  if (engines.way == EngineWay::integrated)
    section.say(
        "The engines integrate at constant speed, {} steps per turn, after a fifth of a turn in "
        "which joints settle; results at {} angles.",
        engines.steps, engines.angles);
  for (const EngineRun& run : engines.runs)
    section.fact(run.name,
                 run.failure.empty()
                     ? fmt::format("{}; {}, tolerance {:g}; {:.1e} of all that joints carry is "
                                   "more than their supports can; {}",
                                   run.text, way_text(engines), run.tolerance, run.residual,
                                   time_text(engines, run))
                     : "no results: " + run.failure);
  for (const auto& [channel, reason] : engines.not_given)
    section.fact(channel, "not given: " + reason);
  section.table = engine_table(engines);
  return section;
}

// A table for the console; `number` is a format.
std::string aligned(const report::Table& table, const char* number) {
  std::vector<std::vector<std::string>> lines = {table.columns};
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (const report::Cell& cell : row) {
      const double* value = std::get_if<double>(&cell);
      lines.back().push_back(value == nullptr      ? std::get<std::string>(cell)
                             : is_computed(*value) ? fmt::format(fmt::runtime(number), *value)
                                                   : "");
    }
  }
  std::string text;
  for (const auto& line : lines) {
    std::string one;
    for (std::size_t column = 0; column < line.size(); ++column) {
      std::size_t width = 0;
      for (const auto& other : lines) width = std::max(width, other[column].size());
      one += fmt::format("{:<{}}  ", line[column], width);
    }
    text += one.substr(0, one.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

// Rows of both pumps, each with its name.
template <class Row>
void name_rows(std::vector<Row>& rows, std::string Row::*text, const std::string& pump) {
  for (Row& row : rows) row.*text = pump + ": " + row.*text;
}
template <class Row>
void add_rows(std::vector<Row>& rows, std::vector<Row> more, std::string Row::*text,
              const ComparisonResult& r) {
  name_rows(rows, text, r.pump_of(Model::analytic));
  name_rows(more, text, r.pump_of(Model::multibody));
  append(rows, std::move(more));
}

// What is said of the first pump is said of the second beside it.
void add_other_pump(report::Document& document, const ComparisonResult& r) {
  report::PlausibilitySection& first = *document.plausibility;
  report::PlausibilitySection second = plausibility_section(r.other->plausibility);
  first.summary = fmt::format("{}: {}; {}: {}", r.pump_of(Model::analytic), first.summary,
                              r.pump_of(Model::multibody), second.summary);
  add_rows(first.warnings, std::move(second.warnings), &report::PlausibilityRow::text, r);
  add_rows(first.meant, std::move(second.meant), &report::PlausibilityRow::text, r);
  add_rows(*document.validity, validity_section(r.other->limits), &report::ValidityRow::limit, r);
  std::vector<TimingRow> timing;
  if (r.second.hydraulics) timing = timing_rows(r.second.the_case, *r.second.hydraulics);
  if (!document.timing && timing.empty()) return;
  if (!document.timing) document.timing.emplace();
  add_rows(*document.timing, std::move(timing), &TimingRow::quantity, r);
}

// The verdict on a reference, its source, and what it says of each figure's reactions.
void add_reference(report::Document& document, const Outcome& outcome) {
  document.verdict->reference = {outcome.name, held_text(outcome),
                                 outcome.state == Outcome::State::agrees};
  report::Section section = source_section(outcome);
  section.table = lines_table({outcome});
  document.runs->insert(document.runs->begin(), std::move(section));
  if (outcome.explanation) {
    document.runs->insert(document.runs->begin() + 1, *explanation_section({outcome}));
  }
  for (report::Figure& figure : *document.figures) {
    const auto* content = std::get_if<report::ChannelFigure>(&figure.content);
    if (content == nullptr) continue;
    for (const GroupLine& line : outcome.lines) {
      const bool shown =
          &line == outcome.worst_line(line.group) &&
          std::any_of(line.channels.begin(), line.channels.end(), [&](const auto& channel) {
            const std::string& name = channel.comparison.channel.name;
            return std::find(content->channels.begin(), content->channels.end(), name) !=
                   content->channels.end();
          });
      if (shown)
        figure.note +=
            fmt::format("{}{}: {}.", figure.note.empty() ? "" : " ", outcome.name, line_text(line));
    }
  }
}

}  // namespace

std::string engine_text(const EngineComparison& engines) {
  std::string text = engines.headline() + "\n";
  text += fmt::format(
      "digits of agreement with the analytic model{}, relative to the peak of a reaction; ! marks "
      "a difference above the tolerance\n",
      engines.curve.empty() ? "" : " and, in the columns named curve, with the stored curve");
  if (!engines.curve.empty())
    text += fmt::format("curve: {}, {} angles\n", engines.curve, engines.curve_angles);
  for (const EngineRun& run : engines.runs)
    text += run.failure.empty()
                ? fmt::format("{}: {}; {}, tolerance {:g}, {}\n", run.name, run.text,
                              way_text(engines), run.tolerance, time_text(engines, run))
                : run.failure + "\n";
  text += aligned(engine_table(engines), "{:g}");
  if (!engines.sweep.empty()) {
    const report::Section section = effort_section(engines);
    text += "\n" + section.title + "\n" + aligned(section.table, "{:.4g}");
  }
  return text;
}

report::Document engine_document(const EngineComparison& engines, const std::string& refusal,
                                 const report::Lines& program, const CaseDescription& description,
                                 const std::string& case_name) {
  report::Document document = case_document(description, case_name, program);
  document.verdict = report::Verdict{engines.agrees(), engines.headline()};
  document.verdict->word = engines.agrees() ? "Engines agree" : "An engine differs";
  if (!engines.any_results()) {
    document.verdict->agrees.reset();
    document.verdict->word = "Nothing compared";
  }
  report::append(document.warnings, std::vector<Warning>{{"Simbody refuses the case", refusal}});
  document.runs.emplace({engine_section(engines)});
  if (!engines.sweep.empty()) document.runs->push_back(effort_section(engines));
  return document;
}

report::Document comparison_document(const ComparisonResult& r, const report::Lines& program,
                                     const CaseDescription& description) {
  const Case& the_case = r.first.the_case;
  std::optional<report::Scene> scene;
  // Of a run that is integrated or of a smaller scene its reactions have other loads beside them.
  const bool all_loads = r.multibody_loads.rows() > 0;
  if (all_loads)
    scene = pump_scene(the_case, {{r.analytic, r.analytic_loads}, {r.multibody, r.multibody_loads}},
                       nullptr, film_path_of(description));
  report::Document document = case_document(description, the_case.name, program, std::move(scene));
  document.verdict = verdict_of(r);
  document.meaning =
      "Agreement verifies that both models solve the same equations correctly. It does not test "
      "what both leave out or share (tables below). Validation, whether a real pump behaves like "
      "this, needs measurements.";
  report::append(document.warnings, r.warnings);
  document.common = common_inputs(the_case, false);
  document.validity = validity_section(r.limits);
  if (r.first.hydraulics) document.timing = timing_rows(r.first.the_case, *r.first.hydraulics);
  if (r.other) add_other_pump(document, r);
  document.models = {report::model_of(r.analytic, in_words(the_case.analytic)),
                     report::model_of(r.multibody, in_words(r.second.the_case.multibody))};
  document.comparison = r.comparison;
  document.checks = r.checks;
  if (r.budget)
    document.budget = budget_section(*r.budget, r.first, r.second, r.analytic, r.multibody);
  document.key_figures = key_figures_of(r, document);
  if (r.split)
    document.assumptions = {
        "The models were run with different assumptions. Each assumption's contribution is its "
        "effect in the analytic model (of the flanks' shape: in the multibody model), averaged "
        "over the orders in which the assumptions can be applied; the rest is a difference between "
        "the models themselves.",
        r.changes, *r.split};
  document.published = r.published;
  document.runs.emplace();
  if (!r.integrations.empty()) document.runs->push_back(integration_section(r));
  document.figures = comparison_figures(r);
  if (r.options.channels.all())
    append(document.figures,
           force_figures({the_case, r.analytic, all_loads ? &r.analytic_loads : nullptr}));
  if (r.first.hydraulics) {
    document.runs->push_back(hydraulic_section(the_case, *r.first.hydraulics));
    append(document.figures, hydraulic_figures(the_case, *r.first.hydraulics));
  }
  if (r.teeth) {
    document.runs->push_back(teeth_section(*r.teeth, the_case.pump));
    document.figures->push_back(teeth_picture(the_case.pump, r.teeth->analytic));
    append(document.figures, teeth_figures(*r.teeth, the_case.pump));
  }
  document.runs->push_back(rounding_section(r.rounding));
  if (r.engines) {
    document.runs->insert(document.runs->begin(), engine_section(*r.engines));
    if (!r.engines->sweep.empty())
      document.runs->insert(document.runs->begin() + 1, effort_section(*r.engines));
  }
  if (r.with) add_reference(document, *r.with);
  return document;
}

report::Curves comparison_curves(const ComparisonResult& r, const report::Document& document,
                                 report::Rows which) {
  std::vector<report::TablePair> pairs = {{r.analytic, r.multibody}};
  if (r.budget) pairs.emplace_back(r.budget->analytic, r.budget->multibody);
  // A reference's curves go with all rows.
  report::Curves curves = report::curves_of(pairs, r.with ? report::Rows::all : which);
  if (!r.with) return curves;
  std::vector<std::string> shown;
  for (const report::Figure& figure : *document.figures)
    if (const auto* content = std::get_if<report::ChannelFigure>(&figure.content))
      for (const std::string& channel : content->channels) add_once(shown, channel);
  curves.reference = reference_curves(*r.with, shown, curves.theta_deg);
  return curves;
}

std::string comparison_text(const ComparisonResult& r) {
  const report::Verdict verdict = verdict_of(r);
  std::string text =
      report::answers_text(r.first.the_case.name, verdict.headline, verdict.answers) +
      report::text_table(r.comparison);
  if (!r.choice.empty()) text += fmt::format("chosen {}\n", r.choice);
  if (r.budget) text += budget_text(*r.budget) + "\n";
  for (const auto& check : r.checks)
    text += fmt::format("{}: {}: {:.1e} of scale, {}\n", check.table, check.name, check.relative(),
                        check.holds() ? "holds" : "violated");
  for (const report::Warning& warning : r.warnings)
    text += fmt::format("warning: {}: {}\n", warning.name, warning.text);
  if (r.published)
    text += fmt::format("published numbers: {}\n", r.published->section.summary.text());
  if (r.with) text += "\n" + regression_text({*r.with});
  if (r.engines) text += "\n" + engine_text(*r.engines);
  return text;
}

}  // namespace bentaxis::study

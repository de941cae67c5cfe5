#include "bentaxis/study/simulation_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "answers_text.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/plausibility_section.h"
#include "bentaxis/study/pump_scene.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/turn_summary.h"
#include "document_parts.h"
#include "fmu_section.h"
#include "key_figures.h"
#include "simulation_parts.h"

namespace bentaxis::study {

std::vector<std::pair<std::string, const Trajectory*>> runs_of(const SimulationResult& r) {
  std::vector<std::pair<std::string, const Trajectory*>> runs;
  if (r.analytic) runs.emplace_back("analytic", &*r.analytic);
  if (r.multibody) runs.emplace_back("multibody", &*r.multibody);
  return runs;
}

report::Values times_of(const Trajectory& run) {
  report::Values times;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    times.push_back(kMilliseconds * run.state(row, StateColumn::time));
  return times;
}

namespace {

std::string milliseconds(double seconds) {
  return fmt::format("{:.4g} ms", seconds * kMilliseconds);
}

// Of the rows of the run that answers.
std::vector<double> seconds_of(const SimulationResult& r) {
  std::vector<double> seconds;
  const Trajectory& run = *runs_of(r).front().second;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    seconds.push_back(run.state(row, StateColumn::time));
  return seconds;
}

std::vector<std::string> sentences_of(const SimulationResult& r) {
  const MotionAnswers& a = r.answers;
  std::vector<std::string> answers;
  if (a.reached_s)
    answers.push_back(fmt::format(
        "Speed: {:g} % of {:.5g} rpm{} after {}{}.", 100 * MotionAnswers::kReached,
        a.first_rpm == 0 ? a.end_rpm : a.end_rpm - a.first_rpm,
        a.first_rpm == 0
            ? ""
            : fmt::format(", the change from {:.5g} to {:.5g} rpm,", a.first_rpm, a.end_rpm),
        milliseconds(*a.reached_s),
        a.settled
            ? ""
            : "; the speed still changes at the end: a longer simulation gives other numbers"));
  if (a.backwards)
    answers.push_back(fmt::format("The shaft also turns backwards: up to {:.4g} rpm at {}.",
                                  a.backwards->rpm, milliseconds(a.backwards->at_s)));
  answers.push_back(fmt::format(
      "Drive torque: at most {:.4g} Nm at {}; work of the drive{} {:.4g} kJ.", a.largest_torque,
      milliseconds(a.largest_torque_s),
      a.drive_has_inertia ? ", which turns its own inertia too," : "", a.drive_work / 1e3));
  if (a.delivery)
    answers.push_back(
        fmt::format("Delivery pressure: at most {:.4g} bar at {}, {:.3g} bar above its mean over "
                    "the last {}, {:.4g} bar.",
                    a.delivery->highest_bar, milliseconds(a.delivery->highest_s),
                    a.delivery->highest_bar - a.delivery->end_bar,
                    a.delivery->end_is_turn ? "turn" : "tenth of the time", a.delivery->end_bar));
  if (a.walls) {
    answers.push_back(fmt::format(
        "Walls: largest force {:.4g} N at {} (piston {}); {}.", a.walls->largest_N,
        milliseconds(a.walls->largest_s), a.walls->piston,
        a.walls->loose == 0
            ? "some wall pushes in every row"
            : fmt::format("no wall pushes in {:.3g} % of the rows", 100 * a.walls->loose)));
    answers.push_back(fmt::format("Block: {:.4g} to {:.4g} deg behind the shaft.",
                                  a.walls->lag_deg[0], a.walls->lag_deg[1]));
  }
  append(answers, limit_answers(a.limits, seconds_of(r)));
  return answers;
}

// A trajectory that a pump does not survive, or that the oil's law was not made for.
std::vector<report::Warning> doubts_of(const SimulationResult& r) {
  constexpr double kNearVacuum = 0.1;  // of the atmosphere
  constexpr double kOverspeed = 3;     // of the speed of [operation]
  const auto [name, run] = runs_of(r).front();
  const Case& the_case = r.ready.the_case;
  double lowest = 0, lowest_at = 0, fastest = 0, fastest_at = 0;
  for (std::size_t row = 0; row < run->lag.size(); ++row) {
    const double time = run->state(row, StateColumn::time),
                 speed = run->state(row, StateColumn::shaft_speed);
    for (int k = 0; k < the_case.pump.geometry.pistons; ++k)
      if (const double p = run->oil->value(row, k); p < lowest) {
        lowest = p;
        lowest_at = time;
      }
    if (std::abs(speed) > std::abs(fastest)) {
      fastest = speed;
      fastest_at = time;
    }
  }
  std::vector<report::Warning> warnings;
  const double atmosphere = the_case.hydraulics->atmosphere / kPascalPerBar;
  if (lowest < (kNearVacuum - 1) * atmosphere)
    warnings.push_back(
        {"course-vacuum",
         fmt::format("a chamber falls to {:.4g} bar gauge at {:.4g} s: it is not filled "
                     "completely, and its pressure follows from the law of the air",
                     lowest, lowest_at)});
  const double usual = std::abs(the_case.operation.speed_rpm);
  if (usual > 0 && std::abs(fastest) > kOverspeed * usual)
    warnings.push_back(
        {"course-overspeed",
         fmt::format("the shaft reaches {:.5g} rpm at {:.4g} s, more than {:g} times the speed of "
                     "[operation]: is an inertia or a load missing?",
                     fastest, fastest_at, kOverspeed)});
  return warnings;
}

std::vector<report::Warning> warnings_of(const SimulationResult& r) {
  std::vector<report::Warning> warnings;
  if (r.oil_follows)
    warnings = doubts_of(r);
  else if (r.ready.hydraulics)
    warnings.push_back(
        {"pressure of constant speed",
         fmt::format("the chamber pressure is the periodic one of {:g} rpm at every speed of the "
                     "motion; the oil does not follow it.",
                     r.ready.the_case.operation.speed_rpm)});
  append(warnings, limit_warnings(r.answers.limits, seconds_of(r)));
  if (r.ready.hydraulics)
    if (auto warning = accuracy_warning(r.ready.the_case, *r.ready.hydraulics))
      warnings.push_back(std::move(*warning));
  if (r.choice.unit) append(warnings, coupling_warnings(r));
  return warnings;
}

std::optional<report::Scene> scene_of(const SimulationResult& r) {
  std::vector<SceneRun> shown;
  SceneMotion motion;
  for (const auto& [name, run] : runs_of(r)) {
    if (run->loads.run_rows() != run->lag.size()) return std::nullopt;
    shown.push_back({run->table.results, run->loads});
  }
  const Trajectory& first = *runs_of(r).front().second;
  motion.time_ms = times_of(first);
  for (std::size_t row = 0; row < first.lag.size(); ++row) {
    motion.shaft.push_back(radians(first.state(row, StateColumn::theta)));
    motion.block.push_back(motion.shaft.back() - first.lag[row]);
  }
  return pump_scene(r.ready.the_case, shown, &motion);
}

report::KeyFigures key_figures_of(const SimulationResult& r) {
  report::KeyFigures key;
  key.at_unit = "ms";
  std::vector<const ResultTable*> tables;
  for (const auto& [name, run] : runs_of(r)) {
    key.models.push_back(name);
    tables.push_back(&run->table.results);
  }
  key.rows = motion_figures(tables, times_of(*runs_of(r).front().second));
  return key;
}

report::Verdict verdict_of(const SimulationResult& r) {
  report::Verdict verdict{r.agrees(), r.headline()};
  if (r.choice.only) verdict.word = r.agrees() ? "Balanced" : "Not balanced";
  if (!r.choice.only) verdict.tolerance = r.choice.error;
  verdict.answers = sentences_of(r);
  verdict.not_valid = not_valid_text(r.answers.limits, seconds_of(r));
  return verdict;
}

std::vector<report::ValidityRow> validity_of(const SimulationResult& r) {
  std::vector<report::ValidityRow> rows = validity_section(r.answers.limits);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].time_s = runs_of(r).front().second->state(r.answers.limits[i].row, StateColumn::time);
  return rows;
}

}  // namespace

report::Document simulation_document(const SimulationResult& r, const report::Lines& program,
                                     const CaseDescription& description) {
  const Case& the_case = r.ready.the_case;
  report::Document document;
  document.title = the_case.name;
  document.program = program;
  put_description(document, description, scene_of(r));
  document.derived = derived_section(the_case);
  document.verdict = verdict_of(r);
  document.meaning =
      r.choice.only
          ? "One model's motion, integrated once. Its balances of work, energy and mass say how "
            "well it was integrated; nothing else was computed that could contradict it. Without "
            "--model both models are run and compared. Whether a pump does so is another question "
            "(docs/limits.md)."
      : r.oil_follows || r.choice.steady
          ? "Two derivations of the mechanics, coupled to the same oil and integrated by the same "
            "method. Agreement verifies that both solve the same equations. The integration error "
            "is estimated by another tolerance, that of the oil by its balances. Whether a pump "
            "behaves like this is validation (docs/limits.md)."
      : r.has_teeth() || r.choice.unit
          ? "Two derivations of the mechanics, integrated by the same method. Agreement verifies "
            "that both solve the same equations. The integration error is estimated by another "
            "tolerance. Whether a pump behaves like this is validation (docs/limits.md)."
          : "Two derivations of the motion, each integrated by its own method, against each other "
            "in time. Agreement verifies that both solve the same equations. Whether a pump "
            "behaves like this is validation (docs/limits.md).";
  document.key_figures = key_figures_of(r);
  report::append(document.warnings, warnings_of(r));
  if (!r.choice.only) document.common = common_inputs(the_case, true, r.oil_follows);
  document.checks = r.checks;
  document.validity = validity_of(r);
  document.models.emplace();
  document.runs = simulation_sections(r);
  for (const auto& [name, run] : runs_of(r)) {
    report::ModelSection model;
    model.name = name;
    model.assumptions =
        in_words(r.ready.assumptions(name == "analytic" ? Model::analytic : Model::multibody));
    model.facts = {{"integrated by", run->record.choice},
                   {"steps", std::to_string(run->record.steps)},
                   {"evaluations", std::to_string(run->record.evaluations)}};
    model.seconds = run->record.seconds;
    model.angles = run->lag.size();
    document.models->push_back(std::move(model));
  }
  document.figures = simulation_figures(r);
  return document;
}

std::string simulation_text(const SimulationResult& r) {
  std::string text = report::answers_text(r.ready.the_case.name, r.headline(), sentences_of(r));
  if (!r.groups.empty()) {
    text += fmt::format("{:<13} {:<17} {:>13} {:>16} {:>12}\n", "group", "       peak",
                        r.choice.steady ? "of peak" : "of peak, time",
                        r.choice.steady ? "" : "of peak, angle", "of allowed");
    for (const GroupDifference& g : r.groups)
      text += fmt::format("{:<13} {:>11.5g} {:<5} {:>13.1e} {:>16} {:>12}\n", g.group, g.peak,
                          g.unit, g.in_time,
                          is_computed(g.over_angle) ? fmt::format("{:.1e}", g.over_angle) : "",
                          g.judged ? fmt::format("{:.2g}", g.of_allowed) : "not compared");
    text += "\n";
  }
  for (const auto& [name, run] : runs_of(r)) {
    const TrajectoryRecord& t = run->record;
    text +=
        fmt::format("{}: {:.3g} s, {} steps, {} evaluations; residual of the work balance {:.1e} J",
                    name, t.seconds, t.steps, t.evaluations, t.worst_work_residual);
    if (compliant(r)) {
      const auto touches = std::count_if(t.events.begin(), t.events.end(),
                                         [](const ToothEvent& event) { return event.touch; });
      text += fmt::format("; {} touches, out of contact {:.3g} % of the time", touches,
                          100 * t.share_out_of_contact);
    }
    text += "\n";
  }
  if (const std::string times = race(r); !times.empty())
    text += fmt::format("for an error of {:g} of peak: {}\n", r.choice.error, times);
  if (r.oil_follows)
    for (const auto& [name, run] : runs_of(r)) {
      const OilHistory& oil = *run->oil;
      text += fmt::format("{}: residual of the oil's energy {:.1e} J, of its mass {:.1e} kg\n",
                          name, oil.worst_energy_residual, oil.worst_mass_residual);
    }
  if (is_computed(r.integration_change))
    text += fmt::format("at a tolerance ten times looser results change by {:.1e} of peak\n",
                        r.integration_change);
  if (!r.multibody_choice.empty()) text += "chosen " + r.multibody_choice + "\n";
  if (r.choice.unit) text += coupling_text(r);
  for (const report::Warning& warning : warnings_of(r))
    text += fmt::format("warning: {}: {}\n", warning.name, warning.text);
  return text;
}

}  // namespace bentaxis::study

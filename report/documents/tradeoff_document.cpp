#include "bentaxis/study/tradeoff_document.h"

#include <span>

#include "bentaxis/study/calibration.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

using report::Cell;

bool is_integrated(const TradeoffRun& run) { return run.method == "integrated"; }

std::string name_of_run(const TradeoffRun& run) {
  std::string name = run.model + " " + run.method;
  if (!run.variant.empty()) name += " " + run.variant;
  if (run.accuracy) name += " " + number_text(*run.accuracy);
  return name;
}

std::string time_text(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", 1e6 * seconds);
  if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return fmt::format("{:.3g} s", seconds);
}

// What to use for which error, in words.
std::vector<std::string> recommendations(const std::vector<TradeoffRun>& runs) {
  std::vector<std::string> lines;
  const TradeoffRun* previous = nullptr;
  for (int digits = 2; digits <= 10; ++digits) {
    const TradeoffRun* run = fastest_within(runs, std::pow(10.0, -digits));
    if (run == nullptr) {
      lines.push_back(fmt::format("For 1e-{} no integrated run is accurate enough.", digits));
      break;
    }
    // One line for all errors that the same run meets: the smallest of them.
    if (run == previous) lines.pop_back();
    lines.push_back(
        fmt::format("For 1e-{} use {} at accuracy {}: {} a turn, error {:.1e} of peak ({}).",
                    digits, run->variant, number_text(*run->accuracy),
                    time_text(run->seconds_per_turn), run->error.worst, run->error.worst_channel));
    previous = run;
  }
  const auto add = [&](const std::string& what, const TradeoffRun& run) {
    lines.push_back(fmt::format("{} takes {} a turn and is accurate to {:.0e}.", what,
                                time_text(run.seconds_per_turn), run.error.worst));
  };
  for (const TradeoffRun& run : runs)
    if (run.done() && run.method == "driven")
      add("Without integrating, the driven scene \"" + run.variant + "\"", run);
  for (const TradeoffRun& run : runs)
    if (run.model == "analytic" &&
        (run.method == "scalar" || &run == &runs.back() || (&run)[1].method != "batch"))
      add("The closed form, " + run.method + (run.variant.empty() ? "" : " (" + run.variant + ")") +
              ",",
          run);
  return lines;
}

// ---- Columns of the table, the CSV and the JSON

struct Column {
  const char* key;
  const char* heading;
  Cell (*cell)(const TradeoffRun&);
};
template <double AchievedError::*member>
Cell error_cell(const TradeoffRun& run) {
  return run.done() && std::isfinite(run.error.*member) ? Cell(run.error.*member) : Cell();
}
template <auto member>
Cell record_cell(const TradeoffRun& run) {
  if (!run.record) return {};
  if constexpr (requires { run.record->whole.*member; })
    return run.record->whole.*member;
  else
    return (*run.record).*member;
}
const std::vector<Column>& columns() {
  static const std::vector<Column> list = {
      {"pressure", "pressure", [](const TradeoffRun& r) { return Cell(r.pressure); }},
      {"model", "model", [](const TradeoffRun& r) { return Cell(r.model); }},
      {"method", "method", [](const TradeoffRun& r) { return Cell(r.method); }},
      {"variant", "scene, integrator", [](const TradeoffRun& r) { return Cell(r.variant); }},
      {"accuracy", "accuracy asked",
       [](const TradeoffRun& r) { return report::cell_of(r.accuracy); }},
      {"seconds_per_turn", "time per turn, s",
       [](const TradeoffRun& r) { return r.done() ? Cell(r.seconds_per_turn) : Cell(); }},
      {"error_worst", "error, worst", error_cell<&AchievedError::worst>},
      {"error_Rs", "error Rs", error_cell<&AchievedError::rs>},
      {"error_Rc", "error Rc", error_cell<&AchievedError::rc>},
      {"error_bearings", "error Rb", error_cell<&AchievedError::bearings>},
      {"error_Rcs", "error Rcs", error_cell<&AchievedError::rcs>},
      {"error_Td", "error Td", error_cell<&AchievedError::td>},
      {"position_drift_m", "constraint error, m",
       record_cell<&multibody::WorstErrors::position_error>},
      {"velocity_drift_m_per_s", "constraint rate error, m/s",
       record_cell<&multibody::WorstErrors::velocity_error>},
      {"gear_phase_rad", "gear phase, rad", record_cell<&multibody::WorstErrors::gear_phase>},
      {"steps", "steps", record_cell<&multibody::IntegrationRecord::steps>},
      {"evaluations", "evaluations", record_cell<&multibody::IntegrationRecord::evaluations>},
      {"status", "status",
       [](const TradeoffRun& r) { return Cell(r.done() ? "done" : "failed: " + r.failure); }}};
  return list;
}

std::vector<TradeoffRun> all_runs(const TradeoffStudy& study) {
  std::vector<TradeoffRun> all;
  for (const auto& pressure : study.pressures) append(all, pressure.runs);
  return all;
}

std::vector<report::Record> records(const TradeoffStudy& study) {
  std::vector<report::Record> rows;
  for (const auto& pressure : study.pressures) {
    const auto front = pareto_front(pressure.runs, is_integrated);
    for (std::size_t i = 0; i < pressure.runs.size(); ++i) {
      const TradeoffRun& run = pressure.runs[i];
      report::Record& row = rows.emplace_back();
      for (const Column& column : columns()) row.emplace_back(column.key, column.cell(run));
      row.back().second = run.done() ? "done" : "failed";
      row.emplace_back("reason", run.done() ? Cell() : Cell(run.failure));
      row.emplace_back("on_front", contains(front, i));
    }
  }
  return rows;
}

// ---- Sections and figures

report::Section table_of(const TradeoffStudy::Pressure& pressure, const TradeoffOptions& options) {
  report::NewSection section(
      fmt::format("Every run, {} pressure", pressure.name),
      fmt::format("One turn, results at {} angles; every one of them ends a step of an integrated "
                  "run. Errors are the largest difference from the closed form in extended "
                  "precision, over the peak.",
                  options.samples_per_revolution));
  const auto own = std::span(columns()).subspan(1);  // the title says the pressure
  section.columns(report::each_of(own, [](const Column& c) { return std::string(c.heading); }));
  for (const TradeoffRun& run : pressure.runs)
    section.row(report::each_of(own, [&](const Column& c) { return c.cell(run); }));
  return section;
}

report::Section orders_of(const TradeoffStudy::Pressure& pressure, const TradeoffOptions& options) {
  report::NewSection section(
      fmt::format("Convergence, {} pressure", pressure.name),
      "Exponent p of error = const x step^p, with the mean step of a run (one turn over its "
      "steps). Runs whose step the samples set, not the accuracy, are left out; so are errors "
      "above 1e-2. An exponent that is off the order of the method, as Simbody states it, by more "
      "than half an order is marked: it is a property of these runs and not of the method (an "
      "order that varies from step to step, edges of the pressure, an extrapolation that the "
      "stated order does not count).");
  section.columns("integrator", "runs", "order, last pair", "order, least squares",
                  "order of the method", "outside it");
  for (const auto integrator : options.integrators) {
    const Order order = order_of(pressure.runs, name_of(integrator));
    const auto theory = multibody::method_orders(integrator);
    section.row(order.integrator, order.runs, order.last_pair, order.least_squares,
                theory.first == theory.second
                    ? fmt::format("{}", theory.first)
                    : fmt::format("{} to {}", theory.first, theory.second),
                outside_theory(order, theory));
  }
  return section;
}

// The same symbol for the same series in every figure: what is not integrated comes first.
int style_of(const TradeoffRun& run) {
  if (run.model == "analytic") return run.method == "scalar" ? 0 : 1;
  if (!is_integrated(run)) return 2;
  const auto& names = multibody::integrator_names();
  return 3 + static_cast<int>(std::ranges::find(names, run.variant) - names.begin());
}

// Runs of the same kind and variant make one series each.
report::Figure figure_of(const TradeoffStudy::Pressure& pressure, bool by_accuracy) {
  const auto& runs = pressure.runs;
  const auto point = [&](const TradeoffRun& run) {
    return report::ScatterPoint{by_accuracy ? *run.accuracy : run.seconds_per_turn, run.error.worst,
                                name_of_run(run)};
  };
  std::vector<report::ScatterSeries> series;
  for (const TradeoffRun& run : runs) {
    if (!run.done() || (by_accuracy && !run.accuracy)) continue;
    const std::string name =
        is_integrated(run)
            ? run.variant
            : run.model + " " + run.method + (run.method == "driven" ? " " + run.variant : "");
    auto it = std::ranges::find_if(series,
                                   [&](const report::ScatterSeries& s) { return s.name == name; });
    if (it == series.end())
      it = series.insert(it, {name, style_of(run), is_integrated(run), false, {}});
    it->points.push_back(point(run));
  }
  if (!by_accuracy) {
    report::ScatterSeries front{"front of the integrated runs", std::nullopt, true, true, {}};
    for (const std::size_t i : pareto_front(runs, is_integrated))
      front.points.push_back(point(runs[i]));
    series.push_back(std::move(front));
  }
  report::Axis x{by_accuracy ? "accuracy asked" : "time per turn (s)", "", true};
  return {
      (by_accuracy ? "accuracy_" : "work_precision_") + pressure.name,
      by_accuracy ? fmt::format("Achieved error against accuracy asked, {} pressure", pressure.name)
                  : fmt::format("Error against time, {} pressure", pressure.name),
      "",
      report::ScatterFigure{std::move(x), {"achieved error, of peak", "", true}, std::move(series)},
      by_accuracy ? ""
                  : "Errors of driven and analytic runs are round-off. Integrated runs have a "
                    "front of their own."};
}

// By pressure: what is fastest for a coarse and for a fine error, and what needs no integration.
std::vector<std::string> answers_of(const TradeoffStudy& study) {
  std::vector<std::string> answers;
  for (const auto& pressure : study.pressures) {
    const TradeoffRun* fastest = report::largest_of(pressure.runs, [](const TradeoffRun& run) {
      return run.done() && !is_integrated(run) ? -run.seconds_per_turn : not_computed();
    });
    if (fastest != nullptr)
      answers.push_back(fmt::format(
          "{} pressure: fastest of all is {}: {} a turn, error {:.0e} of peak.", pressure.name,
          name_of_run(*fastest), time_text(fastest->seconds_per_turn), fastest->error.worst));
    for (const int digits : {4, 8}) {
      const TradeoffRun* run = fastest_within(pressure.runs, std::pow(10.0, -digits));
      answers.push_back(
          run == nullptr
              ? fmt::format("{} pressure: no integrated run has an error below 1e-{} of peak.",
                            pressure.name, digits)
              : fmt::format("{} pressure, integrated in time, error below 1e-{} of peak: {} at "
                            "accuracy {}, {} a turn.",
                            pressure.name, digits, run->variant, number_text(*run->accuracy),
                            time_text(run->seconds_per_turn)));
    }
  }
  return report::each_of(answers, report::sentence);
}

std::string headline_of(const TradeoffStudy& study) {
  const auto runs = all_runs(study);
  const std::size_t failed =
      report::count_of(runs, [](const TradeoffRun& run) { return !run.done(); });
  return fmt::format("{} runs timed on this machine against their error{}.", runs.size(),
                     failed == 0 ? "" : fmt::format("; {} failed", failed));
}

report::Summary summary_of(const TradeoffStudy& study) {
  report::Summary summary{
      "Time needed for a given error, and the fastest sufficient run. Times are of this machine; "
      "compare them within this report only.",
      {}};
  for (const auto& pressure : study.pressures)
    summary.groups.push_back({pressure.name + " pressure", recommendations(pressure.runs)});
  return summary;
}

}  // namespace

report::Document tradeoff_document(const TradeoffStudy& study, const report::Lines& program,
                                   const CaseDescription& description) {
  report::Document document;
  document.title = study.the_case.name + ": speed against error";
  document.program = program;
  put_description(document, description);
  document.summary = summary_of(study);
  document.verdict = {.agrees = std::nullopt,
                      .headline = headline_of(study),
                      .word = "Trade-off",
                      .answers = answers_of(study)};
  document.records = records(study);
  for (const auto& pressure : study.pressures) {
    report::append(document.figures,
                   std::vector{figure_of(pressure, false), figure_of(pressure, true)});
    report::append(document.runs, std::vector{table_of(pressure, study.options),
                                              orders_of(pressure, study.options)});
  }
  return document;
}

std::string tradeoff_csv(const TradeoffStudy& study) {
  CsvRows csv(joined(columns(), ",", [](const Column& column) { return column.key; }));
  for (const TradeoffRun& run : all_runs(study))
    csv.row(report::each_of(columns(), [&](const Column& column) { return column.cell(run); }));
  return std::move(csv).text();
}

std::string tradeoff_text(const TradeoffStudy& study) {
  std::string text =
      report::answers_text(study.the_case.name, headline_of(study), answers_of(study)) +
      report::summary_text(summary_of(study));
  text += fmt::format("\n{:<8} {:<44} {:>12} {:>9} {:>9} {:>8} {:>8}\n", "pressure", "run",
                      "time a turn", "error", "drift, m", "steps", "evals");
  for (const TradeoffRun& run : all_runs(study)) {
    text += fmt::format("{:<8} {:<44} ", run.pressure, name_of_run(run));
    if (!run.done()) {
      text += "failed: " + run.failure + "\n";
      continue;
    }
    text += fmt::format("{:>12} {:>9.1e}", time_text(run.seconds_per_turn), run.error.worst);
    if (run.record)
      text += fmt::format(" {:>9.1e} {:>8} {:>8}", run.record->whole.position_error,
                          run.record->steps, run.record->evaluations);
    text += "\n";
  }
  return text;
}

}  // namespace bentaxis::study

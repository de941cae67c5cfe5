#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/page.h"
#include "bentaxis/study/calibration.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/tradeoff.h"
#include "commands.h"
#include "console.h"
#include "options.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

using report::Json;

struct Options {
  CaseOption the_case;
  std::string out = "out";
  study::TradeoffOptions tradeoff;
};

// A pressure with transitions and one with steps: the case's own and its counterpart.
struct Variant {
  std::string name;
  Case the_case;
};

constexpr double kCounterpartTransition = 20;  // deg, as in the default pump

std::vector<Variant> variants(const Case& the_case) {
  const bool step =
      the_case.pressure.kind == PressureKind::ideal && the_case.pressure.transition_deg == 0;
  Case other = the_case;
  other.pressure.kind = PressureKind::ideal;
  other.pressure.transition_deg = step ? kCounterpartTransition : 0;
  if (step) return {{"smooth", other}, {"step", the_case}};
  return {{"smooth", the_case}, {"step", other}};
}

bool is_integrated(const study::TradeoffRun& run) { return run.method == "integrated"; }

std::string name_of_run(const study::TradeoffRun& run) {
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
std::vector<std::string> recommendations(const std::vector<study::TradeoffRun>& runs) {
  std::vector<std::string> lines;
  const study::TradeoffRun* previous = nullptr;
  std::string previous_target;
  for (int digits = 2; digits <= 10; ++digits) {
    const double target = std::pow(10.0, -digits);
    const study::TradeoffRun* run = study::fastest_within(runs, target);
    if (run == nullptr) {
      lines.push_back(fmt::format("For 1e-{} none of the integrated runs is good enough.", digits));
      break;
    }
    const std::string text =
        fmt::format("For 1e-{} use {} at accuracy {}: {} a turn, error {:.1e} of peak ({}).",
                    digits, run->variant, number_text(*run->accuracy),
                    time_text(run->seconds_per_turn), run->error.worst, run->error.worst_channel);
    // One line for all errors that the same run meets: the smallest of them.
    if (run == previous)
      lines.back() = text;
    else
      lines.push_back(text);
    previous = run;
  }
  for (const study::TradeoffRun& run : runs)
    if (run.done() && run.method == "driven")
      lines.push_back(fmt::format(
          "Without integrating, the driven scene \"{}\" takes {} a turn and is right to {:.0e}.",
          run.variant, time_text(run.seconds_per_turn), run.error.worst));
  for (const study::TradeoffRun& run : runs)
    if (run.model == "analytic" &&
        (run.method == "scalar" || &run == &runs.back() || (&run)[1].method != "batch"))
      lines.push_back(fmt::format("The closed form, {}{}, takes {} a turn and is right to {:.0e}.",
                                  run.method, run.variant.empty() ? "" : " (" + run.variant + ")",
                                  time_text(run.seconds_per_turn), run.error.worst));
  return lines;
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

// The columns of the table, the CSV and the JSON.
using Cell = Json (*)(const study::TradeoffRun&);
struct Column {
  const char* key;
  const char* heading;
  Cell cell;
};
template <double study::AchievedError::*member>
Json error_cell(const study::TradeoffRun& run) {
  return run.done() ? number_or_null(run.error.*member) : Json();
}
template <auto member>
Json record_cell(const study::TradeoffRun& run) {
  return run.record ? Json((*run.record).*member) : Json();
}
template <auto member>
Json drift_cell(const study::TradeoffRun& run) {
  return run.record ? Json(run.record->whole.*member) : Json();
}
const std::vector<Column>& columns() {
  static const std::vector<Column> list = {
      {"pressure", "pressure", [](const study::TradeoffRun& r) { return Json(r.pressure); }},
      {"model", "model", [](const study::TradeoffRun& r) { return Json(r.model); }},
      {"method", "method", [](const study::TradeoffRun& r) { return Json(r.method); }},
      {"variant", "scene, integrator", [](const study::TradeoffRun& r) { return Json(r.variant); }},
      {"accuracy", "accuracy asked",
       [](const study::TradeoffRun& r) { return r.accuracy ? Json(*r.accuracy) : Json(); }},
      {"seconds_per_turn", "time per turn, s",
       [](const study::TradeoffRun& r) { return r.done() ? Json(r.seconds_per_turn) : Json(); }},
      {"error_worst", "error, worst", error_cell<&study::AchievedError::worst>},
      {"error_Rs", "error Rs", error_cell<&study::AchievedError::rs>},
      {"error_Rc", "error Rc", error_cell<&study::AchievedError::rc>},
      {"error_bearings", "error Rb", error_cell<&study::AchievedError::bearings>},
      {"error_Rcs", "error Rcs", error_cell<&study::AchievedError::rcs>},
      {"error_Td", "error Td", error_cell<&study::AchievedError::td>},
      {"position_drift_m", "constraint error, m",
       drift_cell<&multibody::WorstErrors::position_error>},
      {"velocity_drift_m_per_s", "constraint rate error, m/s",
       drift_cell<&multibody::WorstErrors::velocity_error>},
      {"gear_phase_rad", "gear phase, rad", drift_cell<&multibody::WorstErrors::gear_phase>},
      {"steps", "steps", record_cell<&multibody::IntegrationRecord::steps>},
      {"evaluations", "evaluations", record_cell<&multibody::IntegrationRecord::evaluations>},
      {"status", "status", [](const study::TradeoffRun& r) {
         return Json(r.done() ? "done" : "failed: " + r.failure);
       }}};
  return list;
}

std::string csv_field(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_number_integer()) return std::to_string(value.get<long>());
  if (value.is_number()) return number_text(value.get<double>());
  std::string text = value.get<std::string>();
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv_of(const std::vector<study::TradeoffRun>& runs) {
  std::string text;
  for (const Column& column : columns())
    text += (text.empty() ? "" : ",") + std::string(column.key);
  text += "\n";
  for (const study::TradeoffRun& run : runs) {
    bool first = true;
    for (const Column& column : columns()) {
      if (!first) text += ',';
      first = false;
      text += csv_field(column.cell(run));
    }
    text += '\n';
  }
  return text;
}

Json json_of(const std::vector<study::TradeoffRun>& runs) {
  std::vector<std::size_t> front;  // of each pressure
  for (const char* pressure : {"smooth", "step"})
    for (const std::size_t i : study::pareto_front(runs, [&](const study::TradeoffRun& run) {
           return is_integrated(run) && run.pressure == pressure;
         }))
      front.push_back(i);
  Json rows = Json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Json row;
    for (const Column& column : columns()) row[column.key] = column.cell(runs[i]);
    row["status"] = runs[i].done() ? "done" : "failed";
    row["reason"] = runs[i].done() ? Json() : Json(runs[i].failure);
    row["on_front"] = std::find(front.begin(), front.end(), i) != front.end();
    rows.push_back(std::move(row));
  }
  return rows;
}

Json table_of(const std::vector<study::TradeoffRun>& runs, const study::TradeoffOptions& options,
              const std::string& pressure) {
  Json headings = Json::array();
  Json rows = Json::array();
  for (std::size_t c = 1; c < columns().size(); ++c) headings.push_back(columns()[c].heading);
  for (const study::TradeoffRun& run : runs) {
    Json row = Json::array();
    for (std::size_t c = 1; c < columns().size(); ++c) row.push_back(columns()[c].cell(run));
    rows.push_back(std::move(row));
  }
  return {
      {"title", fmt::format("Every run, {} pressure", pressure)},
      {"text", fmt::format("One turn, results at {} angles; every one of them ends a step of an "
                           "integrated run. Errors are the largest difference from the closed "
                           "form in extended precision, over the peak.",
                           options.samples_per_revolution)},
      {"facts", nullptr},
      {"table", {{"columns", headings}, {"rows", rows}}}};
}

Json orders_of(const std::vector<study::TradeoffRun>& runs, const study::TradeoffOptions& options,
               const std::string& pressure) {
  Json rows = Json::array();
  for (const auto integrator : options.integrators) {
    const study::Order order = study::order_of(runs, study::name_of(integrator));
    rows.push_back({order.integrator, order.runs, order.last_pair ? Json(*order.last_pair) : Json(),
                    order.least_squares ? Json(*order.least_squares) : Json()});
  }
  return {{"title", fmt::format("Convergence, {} pressure", pressure)},
          {"text",
           "Exponent p of error = const x step^p, with the mean step of a run (one turn over "
           "its steps). Runs whose step the samples set, not the accuracy, are left out; so "
           "are errors above 1e-2. CPodes varies its order, so its exponent is no property "
           "of the method."},
          {"facts", nullptr},
          {"table",
           {{"columns", {"integrator", "runs", "order, last pair", "order, least squares"}},
            {"rows", rows}}}};
}

Json point_of(const study::TradeoffRun& run, double x) {
  return {{"x", x}, {"y", run.error.worst}, {"note", name_of_run(run)}};
}

// The same symbol for the same series in every figure: what is not integrated comes first.
int style_of(const study::TradeoffRun& run) {
  if (run.model == "analytic") return run.method == "scalar" ? 0 : 1;
  if (!is_integrated(run)) return 2;
  const auto& names = multibody::integrator_names();
  return 3 + static_cast<int>(std::find(names.begin(), names.end(), run.variant) - names.begin());
}

// Runs of the same kind and variant make one series each.
Json figure_of(const std::vector<study::TradeoffRun>& runs, const std::string& pressure,
               bool by_accuracy) {
  std::map<std::string, Json> by_name;
  std::vector<std::string> names;
  for (const study::TradeoffRun& run : runs) {
    if (!run.done() || (by_accuracy && !run.accuracy)) continue;
    const std::string name =
        is_integrated(run)
            ? run.variant
            : run.model + " " + run.method + (run.method == "driven" ? " " + run.variant : "");
    if (by_name.find(name) == by_name.end()) {
      names.push_back(name);
      by_name[name] = {{"name", name},
                       {"style", style_of(run)},
                       {"line", is_integrated(run)},
                       {"points", Json::array()}};
    }
    by_name[name]["points"].push_back(
        point_of(run, by_accuracy ? *run.accuracy : run.seconds_per_turn));
  }
  Json series = Json::array();
  for (const std::string& name : names) series.push_back(by_name[name]);
  if (!by_accuracy) {
    Json front = {{"name", "front of the integrated runs"},
                  {"line", true},
                  {"emphasis", true},
                  {"points", Json::array()}};
    for (const std::size_t i : study::pareto_front(runs, is_integrated))
      front["points"].push_back(point_of(runs[i], runs[i].seconds_per_turn));
    series.push_back(front);
  }
  return {
      {"id", (by_accuracy ? "accuracy_" : "work_precision_") + pressure},
      {"kind", "scatter"},
      {"title", by_accuracy
                    ? fmt::format("Achieved error against accuracy asked, {} pressure", pressure)
                    : fmt::format("Error against time, {} pressure", pressure)},
      {"x", {{"label", by_accuracy ? "accuracy asked" : "time per turn (s)"}, {"log", true}}},
      {"y", {{"label", "achieved error, of peak"}, {"log", true}}},
      {"series", series},
      {"note", by_accuracy ? ""
                           : "Driven and analytic runs have no error to trade: what they show is "
                             "round-off. Integrated runs have a front of their own."}};
}

int tradeoff(Options options) {
  const Case the_case = study::prepare(options.the_case.read(), progress_of).the_case;
  if (the_case.operation.speed_rpm == 0)
    throw InputError(
        options.the_case.file +
        ": [operation] speed_rpm = 0: tradeoff integrates in time, which needs a speed "
        "other than 0");
  OutputFolder folder(options.out);
  // A few angles per pitch, so that one piston can stand for all where it may.
  if (options.tradeoff.samples_per_revolution == 0)
    options.tradeoff.samples_per_revolution = 8 * the_case.pump.geometry.pistons;
  const Progress progress = progress_of("tradeoff");
  const std::vector<Variant> both = variants(the_case);

  std::vector<study::TradeoffRun> all;
  Json tables = Json::array();
  Json figures = Json::array();
  Json summary = {{"text",
                   "What a given error costs, and the fastest that is good enough. Times are "
                   "of this machine; compare them within this report only."},
                  {"groups", Json::array()}};
  for (std::size_t v = 0; v < both.size(); ++v) {
    const auto runs = study::measure_tradeoff(
        both[v].the_case, both[v].name, options.tradeoff, [&](double fraction) {
          progress((static_cast<double>(v) + fraction) / static_cast<double>(both.size()));
        });
    summary["groups"].push_back(
        {{"title", both[v].name + " pressure"}, {"lines", recommendations(runs)}});
    figures.push_back(figure_of(runs, both[v].name, false));
    figures.push_back(figure_of(runs, both[v].name, true));
    tables.push_back(table_of(runs, options.tradeoff, both[v].name));
    tables.push_back(orders_of(runs, options.tradeoff, both[v].name));
    all.insert(all.end(), runs.begin(), runs.end());
  }
  report::Document head;
  head.the_case = study::case_section(the_case);
  Json report = {{"schema", 1},           {"title", the_case.name + ": speed against error"},
                 {"program", versions()}, {"case", report::to_json(head)["case"]},
                 {"summary", summary},    {"rows", json_of(all)},
                 {"runs", tables},        {"figures", figures}};
  folder.add("tradeoff.html",
             report::render_page(the_case.name + ": speed against error", report, Json::object()));
  folder.add("tradeoff.json", report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  folder.add("tradeoff.csv", csv_of(all));
  const auto paths = folder.commit();

  for (const auto& group : summary["groups"]) {
    std::printf("%s\n", group["title"].get<std::string>().c_str());
    for (const auto& line : group["lines"]) std::printf("  %s\n", line.get<std::string>().c_str());
  }
  std::printf("\n%-8s %-44s %12s %9s %9s %8s %8s\n", "pressure", "run", "time a turn", "error",
              "drift, m", "steps", "evals");
  for (const study::TradeoffRun& run : all) {
    if (!run.done()) {
      std::printf("%-8s %-44s failed: %s\n", run.pressure.c_str(), name_of_run(run).c_str(),
                  run.failure.c_str());
      continue;
    }
    std::printf("%-8s %-44s %12s %9.1e", run.pressure.c_str(), name_of_run(run).c_str(),
                time_text(run.seconds_per_turn).c_str(), run.error.worst);
    if (run.record)
      std::printf(" %9.1e %8ld %8ld", run.record->whole.position_error, run.record->steps,
                  run.record->evaluations);
    std::printf("\n");
  }
  std::printf("\n");
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return kDone;
}

}  // namespace

Command add_tradeoff_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "tradeoff", "Time every model, scene, integrator and accuracy on a case against its error");
  add_case(*command, options->the_case);
  add_out(*command, options->out, "tradeoff.html, tradeoff.json and tradeoff.csv");
  study::TradeoffOptions& tradeoff_options = options->tradeoff;
  add_integrators(*command, tradeoff_options.integrators);
  command->add_option("--accuracies", tradeoff_options.accuracies, "accuracies of integrated runs")
      ->delimiter(',')
      ->check(accuracy_range())
      ->option_text("NUMBER[,NUMBER..] [1e-2,1e-3,..,1e-10]");
  command
      ->add_option("--samples", tradeoff_options.samples_per_revolution,
                   "angles per turn at which results are taken; each ends a step")
      ->check(CLI::Range(1, 100000))
      ->option_text("NUMBER [8 per piston]");
  command
      ->add_option("--max-seconds-per-run", tradeoff_options.max_seconds_per_run,
                   "stop an integrated run that takes longer, and try no tighter accuracy")
      ->check(positive_number())
      ->option_text("NUMBER [10]");
  return {command, [options] {
            study::TradeoffOptions& o = options->tradeoff;
            if (o.integrators.empty()) o.integrators = study::all_integrators();
            if (o.accuracies.empty())
              o.accuracies = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
            std::sort(o.accuracies.rbegin(), o.accuracies.rend());
            return tradeoff(*options);
          }};
}

}  // namespace bentaxis::cli

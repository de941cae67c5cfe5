#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/page.h"
#include "bentaxis/study/hard_cases.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "options.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

using study::GroupLoss;
using study::hard_models;
using study::HardCase;
using study::HardOutcome;
using study::HardVerdict;
using study::kNoticeableLoss;
using study::kPredictionFactor;
using study::LongRun;
using Json = nlohmann::json;

struct Options {
  std::string out = "out", catalogue, filter;
  int turns = 20;
};

struct Row {
  HardCase hard;
  HardOutcome outcome;
};

double digits(double loss) { return loss > 0 ? std::clamp(-std::log10(loss), 0.0, 16.0) : 16; }

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

bool misjudged(const HardOutcome& outcome) {
  const auto ratio = outcome.worst_ratio();
  return ratio && (*ratio > kPredictionFactor || *ratio < 1 / kPredictionFactor);
}

Json json_of(const std::vector<Row>& rows) {
  Json cases = Json::array();
  for (const auto& [hard, o] : rows) {
    if (cases.empty() || cases.back()["name"] != hard.name)
      cases.push_back({{"name", hard.name},
                       {"group", hard.group},
                       {"hard", hard.hard},
                       {"changes", hard.changes},
                       {"models", Json::array()}});
    Json groups = Json::array();
    for (const GroupLoss& g : o.groups)
      groups.push_back(
          {{"group", g.group}, {"loss_over_peak", g.measured}, {"predicted", g.predicted}});
    const auto ratio = o.worst_ratio();
    cases.back()["models"].push_back(
        {{"model", o.model},
         {"expected", o.refusal_expected ? "refused" : "accurate"},
         {"verdict", to_string(o.verdict)},
         {"message", o.message},
         {"digits", o.worst() ? Json(digits(o.worst()->measured)) : Json()},
         {"groups", groups},
         {"weak_point", o.weak_point},
         {"measured_over_predicted", ratio ? Json(*ratio) : Json()},
         {"microseconds_per_angle", o.seconds_per_angle * 1e6}});
  }
  return cases;
}

std::string csv_of(const std::vector<Row>& rows) {
  std::string text =
      "case,model,expected,verdict,group,loss_over_peak,predicted_over_peak,digits,us_per_angle\n";
  for (const auto& [hard, o] : rows) {
    const GroupLoss* worst = o.worst();
    text += fmt::format("{},{},{},{},", hard.name, o.model,
                        o.refusal_expected ? "refused" : "accurate", to_string(o.verdict));
    if (worst != nullptr)
      text += fmt::format("{},{},{},{:.1f},{:.1f}\n", worst->group, number_text(worst->measured),
                          number_text(worst->predicted), digits(worst->measured),
                          o.seconds_per_angle * 1e6);
    else
      text += ",,,,\n";
  }
  return text;
}

std::string cell(const HardOutcome& o) {
  if (o.verdict == HardVerdict::refused) return "refused";
  const GroupLoss* worst = o.worst();
  if (worst == nullptr) return to_string(o.verdict);
  return fmt::format("{}{:.1f} ({:.1f})", o.verdict == HardVerdict::wrong ? "WRONG " : "",
                     digits(worst->measured), digits(worst->predicted));
}

// The table of docs/trust.md.
std::string markdown_of(const std::vector<Row>& rows) {
  std::string text = "| case | what is hard |";
  std::string rule = "|---|---|";
  for (const auto& model : hard_models()) {
    text += " " + model + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (std::size_t i = 0; i < rows.size(); i += hard_models().size()) {
    text += fmt::format("| `{}` | {} |", rows[i].hard.name, rows[i].hard.hard);
    for (std::size_t m = 0; m < hard_models().size(); ++m)
      text += " " + cell(rows[i + m].outcome) + " |";
    text += "\n";
  }
  return text;
}

// One block per group of cases, a row per case.
Json page_runs(const std::vector<Row>& rows) {
  Json columns = {"case", "what is hard", "set to"};
  for (const auto& model : hard_models()) columns.push_back(model);
  columns.push_back("message");
  Json runs = Json::array();
  for (std::size_t i = 0; i < rows.size(); i += hard_models().size()) {
    const HardCase& hard = rows[i].hard;
    auto block = std::find_if(runs.begin(), runs.end(),
                              [&](const Json& r) { return r["title"] == hard.group; });
    if (block == runs.end()) {
      runs.push_back({{"title", hard.group},
                      {"text",
                       "Digits of the worst reaction, in brackets those predicted, and which "
                       "reaction it is."},
                      {"table", {{"columns", columns}, {"rows", Json::array()}}}});
      block = runs.end() - 1;
    }
    Json row = {hard.name, hard.hard, joined(hard.changes, ", ")};
    std::vector<std::string> messages;
    for (std::size_t m = 0; m < hard_models().size(); ++m) {
      const HardOutcome& o = rows[i + m].outcome;
      row.push_back(cell(o) + (o.worst() ? " " + o.worst()->group : ""));
      if (!o.message.empty()) messages.push_back(o.model + ": " + o.message);
    }
    row.push_back(joined(messages, "; "));
    (*block)["table"]["rows"].push_back(row);
  }
  return runs;
}

Json page_of(const LongRun& run) {
  Json rows = Json::array();
  for (const auto& t : run.shown)
    rows.push_back({t.number, t.record.position_error, t.record.velocity_error, t.record.gear_phase,
                    t.record.spin_error, t.record.work_residual, t.reaction_error});
  return {
      {"title", fmt::format("{} turns integrated", run.turns)},
      {"text",
       fmt::format("Real pistons spinning, accuracy {:g}; worst within the turn, work since the "
                   "start of {:.4g} J that the loads did. {:.3g} s a turn. Second half over "
                   "first half: constraint error {:.2g}, reaction error {:.2g}.",
                   run.accuracy, run.work_of_loads, run.seconds / run.turns,
                   run.position_error[1] / run.position_error[0],
                   run.reaction_error[1] / run.reaction_error[0])},
      {"table",
       {{"columns",
         {"turn", "constraint error, m", "its rate, m/s", "gear phase, rad", "spin error, rad/s",
          "work lost, J", "reaction error, of peak"}},
        {"rows", rows}}}};
}

void print(const LongRun& run) {
  std::printf(
      "\n%d turns integrated, accuracy %g, %.3g s a turn; worst within the turn:\n%6s %12s "
      "%12s %12s %12s %12s %12s\n",
      run.turns, run.accuracy, run.seconds / run.turns, "turn", "constraint/m", "rate/(m/s)",
      "phase/rad", "spin/(rad/s)", "work lost/J", "reaction");
  for (const auto& t : run.shown)
    std::printf("%6d %12.1e %12.1e %12.1e %12.1e %12.1e %12.1e\n", t.number,
                t.record.position_error, t.record.velocity_error, t.record.gear_phase,
                t.record.spin_error, t.record.work_residual, t.reaction_error);
}

int run(const Options& options) {
  const auto shipped = shipped_reference_data();
  if (options.catalogue.empty() && !shipped)
    throw InputError("no catalogue is installed with this program: name one with --catalogue");
  const std::filesystem::path folder =
      options.catalogue.empty() ? *shipped / "hard" : std::filesystem::path(options.catalogue);
  const auto cases = study::read_catalogue(folder, options.filter);
  OutputFolder out(options.out);
  std::vector<Row> rows;
  std::printf("%-24s %-10s %-9s %7s %10s %9s  %s\n", "case", "model", "verdict", "digits",
              "predicted", "us/angle", "least in, message");
  for (const HardCase& hard : cases) {
    for (HardOutcome& o : study::run_hard_case(hard, progress_of)) {
      const GroupLoss* worst = o.worst();
      std::printf("%-24s %-10s %-9s", hard.name.c_str(), o.model.c_str(), to_string(o.verdict));
      if (worst != nullptr)
        std::printf(" %7.1f %10.1f %9.1f  %s %s\n", digits(worst->measured),
                    digits(worst->predicted), o.seconds_per_angle * 1e6, worst->group.c_str(),
                    o.message.c_str());
      else
        std::printf(" %7s %10s %9s  %s\n", "", "", "", o.message.c_str());
      std::fflush(stdout);
      rows.push_back({hard, std::move(o)});
    }
  }
  std::map<std::string, int> counts;
  int unpredicted = 0;
  for (const Row& row : rows) {
    ++counts[to_string(row.outcome.verdict)];
    if (!misjudged(row.outcome)) continue;
    ++unpredicted;
    std::printf("%s, %s: measured over predicted loss %.1e\n", row.hard.name.c_str(),
                row.outcome.model.c_str(), *row.outcome.worst_ratio());
  }
  std::optional<LongRun> long_run;
  if (options.turns > 0 && options.filter.empty()) {
    constexpr double kAccuracy = 1e-6;
    long_run = study::run_long(folder, options.turns, kAccuracy, progress_of);
    print(*long_run);
  }
  const bool bounded = !long_run || long_run->bounded();
  const bool good = counts["WRONG"] == 0 && unpredicted == 0 && bounded;
  std::string headline = fmt::format(
      "{} cases, each by {} ways: {} accurate within the predicted loss, {} refused with a "
      "message, {} "
      "wrong. Losses above {:g} of peak that were not predicted within a factor of {:g}: {}.",
      cases.size(), hard_models().size(), counts["accurate"], counts["refused"], counts["WRONG"],
      kNoticeableLoss, kPredictionFactor, unpredicted);
  if (long_run)
    headline += fmt::format(" Over {} integrated turns errors {}.", long_run->turns,
                            bounded ? "do not grow" : "GROW");

  Json report = {
      {"schema", 1},
      {"title", "Hard cases"},
      {"program", versions()},
      {"verdict", {{"agrees", good}, {"word", good ? "Holds" : "Fails"}, {"headline", headline}}},
      {"meaning",
       "Digits are -log10 of the largest difference from the 50-digit curve over the peak of the "
       "reaction; predicted are the digits that the rounding of inputs and arithmetic leaves "
       "(docs/trust.md)."}};
  Json page = report;
  report["cases"] = json_of(rows);
  page["runs"] = page_runs(rows);
  if (long_run) {
    page["runs"].push_back(page_of(*long_run));
    report["long_run"] = page["runs"].back();
    report["long_run"]["bounded"] = bounded;
  }
  out.add("hardcases.html", report::render_page("Hard cases", page, Json::object()));
  out.add("hardcases.json", report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  out.add("hardcases.csv", csv_of(rows));
  out.add("hardcases.md", markdown_of(rows));
  std::printf("\n%s\n\n", headline.c_str());
  for (const auto& path : out.commit()) std::printf("%s\n", path.c_str());
  return good ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_hardcases_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "hardcases", "Run the catalogue of hard cases: digits achieved and predicted, refusals");
  add_out(*command, options->out, "hardcases.html, .json, .csv and .md");
  command->add_option("--filter", options->filter, "only cases whose name contains this")
      ->option_text("TEXT");
  command
      ->add_option("--turns", options->turns,
                   "length of the integrated run; 0 leaves it out, as --filter does")
      ->check(CLI::Range(0, 100000))
      ->option_text("NUMBER [20]");
  command
      ->add_option("--catalogue", options->catalogue,
                   "folder with another catalogue.toml and its cases")
      ->option_text("DIR");
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/study/assumptions.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "bentaxis/study/engine_comparison.h"
#include "bentaxis/study/timing.h"
#include "command_tools.h"
#include "compare_parts.h"
#include "result_files.h"

namespace bentaxis::cli {
namespace {

struct CompareOptions {
  CaseOption the_case;
  ReportPlace place;
  std::string multibody_case;  // another case for the multibody model; empty = the same
  std::string with;            // a reference folder
  std::optional<double> tolerance;
  int uncertainty = 0;  // samples
  RunChoice choice;
  std::vector<std::string> analytic, multibody;  // KEY=VALUE assumptions
  study::EngineOptions engines;
  int engine_steps = 0;  // 0: not given
};

// An option that changes nothing is a mistake: it would look as if an engine had run.
void refuse_engine_options_without_effect(const CompareOptions& options) {
  const bool integrated = options.engines.way == study::EngineWay::integrated;
  const std::pair<bool, const char*> given[] = {
      {integrated, "--engine-way integrated"},
      {options.engine_steps != 0, "--engine-steps"},
      {!options.engines.settings.empty(), "--engine-setting"},
      {options.engines.sweep, "--engine-sweep"}};
  if (options.engines.names.empty()) {
    for (const auto& [is_given, option] : given)
      if (is_given) throw InputError(std::string(option) + ": must have --engine NAME beside it");
  } else if (!integrated) {
    if (options.engine_steps != 0)
      throw InputError("--engine-steps: must have --engine-way integrated beside it");
    if (!options.engines.settings.empty() && !options.engines.sweep)
      throw InputError(
          "--engine-setting: must have --engine-way integrated or --engine-sweep beside it");
  }
}

// What drives the block is an assumption that the case file says too: it is read as a change of it.
constexpr char kTransfer[] = "transfer=";
std::string all_transfers() {
  return kTransfer + fmt::format("{}", fmt::join(transfer_names(), "|"));
}
bool is_transfer(const std::string& text) { return text.starts_with(kTransfer); }
Case read_with(CaseOption of, const std::string& option,
               const std::vector<std::string>& assumptions, bool two_pumps) {
  for (const std::string& text : assumptions) {
    if (!is_transfer(text)) continue;
    const std::string kind = text.substr(std::size(kTransfer) - 1);
    if (!contains(transfer_names(), kind))
      throw InputError(option + " " + text + ": must be " + all_transfers());
    of.changes.push_back("transfer.kind=" + kind);
  }
  return of.read(two_pumps ? option.substr(2) + " model, " + of.file + ": " : "");
}

// @return whether every engine has given results
bool say_failures(const study::EngineComparison& engines) {
  const std::vector<std::string> failures = engines.failures();
  for (const std::string& failure : failures)
    std::fprintf(stderr, "bentaxis: engine %s\n", failure.c_str());
  return failures.empty();
}

// Simbody refuses the case: the analytic model and the engines are all there is.
int judge_by_engines(const Case& given, const study::EngineOptions& options,
                     const ComputationError& refusal, ReportFolders& folders) {
  const study::PreparedCase ready = study::prepare(given, progress_of);
  const ResultTable analytic = study::run_turn(ready, study::Model::analytic, progress_of);
  const study::EngineComparison engines = options.calls->compare(
      ready, options, analytic, nullptr, study::kDrivenTolerance, progress_of);
  report::Document document = study::engine_document(
      engines, refusal.what(), versions(), described(ready.the_case), ready.the_case.name);
  std::vector<TextFile> curves = engine_files(engines);
  curves.emplace_back("analytic.csv", to_csv(analytic));
  folders.publish("report", study::engine_text(engines), document, curves,
                  report::curves_of(analytic));
  std::fprintf(stderr, "bentaxis: %s\n", refusal.what());
  say_failures(engines);
  return engines.agrees() ? kComputationFailed : kOutOfTolerance;
}

int compare(const CompareOptions& options) {
  options.choice.refuse_without_effect(true);
  refuse_engine_options_without_effect(options);
  if (!options.engines.names.empty()) require_whole_program("--engine");
  if (!options.with.empty()) require_whole_program("--with");
  if (options.uncertainty > 0) require_whole_program("--uncertainty");
  const auto names_transfer = [](const std::vector<std::string>& assumptions) {
    return std::any_of(assumptions.begin(), assumptions.end(), is_transfer);
  };
  const bool transfer = names_transfer(options.analytic) || names_transfer(options.multibody);
  if (transfer && !options.multibody_case.empty())
    throw InputError(
        "--multibody-case: must be left out beside an assumption transfer=..: the other case says "
        "itself what drives its block");
  CaseOption of_second = options.the_case;
  if (!options.multibody_case.empty()) of_second.file = options.multibody_case;
  const bool two_pumps = transfer || !options.multibody_case.empty();
  Case first = read_with(options.the_case, "--analytic", options.analytic, two_pumps);
  std::optional<Case> second;
  if (two_pumps) second = read_with(of_second, "--multibody", options.multibody, true);
  for (const auto& text : options.analytic)
    if (!is_transfer(text)) study::apply_assumption(text, first.pump, first.analytic);
  Case& of_multibody = second ? *second : first;
  for (const auto& text : options.multibody)
    if (!is_transfer(text))
      study::apply_assumption(text, of_multibody.pump, of_multibody.multibody);
  if (second) study::check_same_run(first, *second);
  const Case given = first;
  const auto samples = static_cast<std::size_t>(options.uncertainty);
  if (samples > 0) check_sampling(given, samples);
  ReportFolders folders(options.place);
  if (folders.has_figures()) study::require_memory(given, study::Kept::drawn, options.choice.way);

  study::ComparisonOptions how;
  how.way = options.choice.way;
  how.tolerance = options.tolerance;
  how.channels = options.choice.channels();
  how.scene = options.choice.scene_for(first);
  how.integration = options.choice.integration;
  if (!options.choice.accuracies.empty()) how.accuracies = options.choice.accuracies;
  how.target = options.choice.target();
  how.with = options.with;
  how.split_transfer = transfer;
  how.loads = true;
  how.scratch = folders.tables().path();
  study::EngineOptions engines = options.engines;
  if (options.engine_steps != 0) engines.steps = options.engine_steps;
  if (const auto data = shipped_reference_data()) {
    how.published = *data / "published";
    engines.curves = {*data / "high_precision", *data / "transfers"};
  }
  if (!engines.names.empty())
    how.engines = std::make_shared<study::EngineOptions>(std::move(engines));
  std::optional<study::ComparisonResult> compared;
  try {
    compared = study::compare_models(std::move(first), std::move(second), how, progress_of);
  } catch (const ComputationError& refusal) {
    if (!how.engines || how.way != study::Way::driven) throw;
    return judge_by_engines(given, *how.engines, refusal, folders);
  }
  study::ComparisonResult& result = *compared;
  if (result.with) explain_differences(*result.with, given, progress_of);

  const auto refuse = [&](const CaseOption& of, const study::PreparedCase& ready) {
    if (ready.hydraulics)
      of.refuse_timing(
          study::timing_warnings(study::timing_rows(ready.the_case, *ready.hydraulics)));
  };
  refuse(options.the_case, result.first);
  if (two_pumps) refuse(of_second, result.second);

  std::vector<TextFile> curves = comparison_files(result);
  report::Document document =
      study::comparison_document(result, versions(), study::describe(result, progress_of));
  std::string known;  // how well
  if (samples > 0) {
    KnownHowWell how_well = add_uncertainty(document, given, result, samples, progress_of);
    curves.push_back(std::move(how_well.bands));
    known = how_well.text + "\n";
  }
  const report::Rows rows = folders.has_figures() ? report::Rows::all : report::Rows::shown;
  folders.publish("report", study::comparison_text(result) + known, document, curves,
                  study::comparison_curves(result, document, rows));
  const bool all_ran = !result.engines || say_failures(*result.engines);
  if (!result.passes()) return kOutOfTolerance;
  return all_ran ? kDone : kComputationFailed;
}

}  // namespace

Command add_compare_command(CommandParser program) {
  auto options = std::make_shared<CompareOptions>();
  auto command = program.subcommand("compare", "Run both models and report their differences");
  add_case(command, options->the_case);
  add_report(command, options->place, "report.html, report.json and the curves");
  command.option("--tolerance", options->tolerance,
                 Values::positive("NUMBER [1e-9 driven, 100 x accuracy integrated]"),
                 "largest difference over a reaction's peak that counts as agreement");
  options->choice.add_to(command, true);
  command.option("--analytic", options->analytic, "KEY=VALUE ..",
                 "assumption of the analytic model: piston_friction=on|off, "
                 "inertia=lumped|real|dynamically_equivalent, gear=mesh|imposed, "
                 "flank_shape=involute|octoid, " +
                     all_transfers() + "; overrides the case file");
  command.option("--multibody", options->multibody, "KEY=VALUE ..",
                 "the same for the multibody model");
  command.option(
      "--multibody-case", options->multibody_case, Values::case_file("CASE"),
      "give the multibody model another case, changed by --set alike: shows the effect of a wrong "
      "input");
  command.option(
      "--with", options->with, "FOLDER",
      "reference directory whose curves are compared with both models; exit status 1 where one "
      "differs by more than its tolerance");
  command.option(
      "--engine", options->engines.names,
      Values("NAME[,NAME..]").list().completed_with(engine_names()),
      "run engines of others too: exit status 1 where one differs by more than its tolerance, 3 "
      "where one cannot be run");
  command.choice("--engine-way", options->engines.way, {"given", "integrated"},
                 "given: inverse dynamics at given motion; integrated: by the engine's own "
                 "integrator and constraints");
  command.option("--engine-steps", options->engine_steps,
                 Values::integers(36, 1'000'000, fmt::format("NUMBER [{}]", study::kEngineSteps)),
                 "steps per turn of engines that integrate; best a multiple of the samples");
  command.option(
      "--engine-setting", options->engines.settings, "ENGINE.NAME=VALUE ..",
      "a setting of an engine that integrates, mujoco.time_constant=1; docs/engines.md lists them");
  command.flag("--engine-sweep", options->engines.sweep,
               "time against error of the engines, integrated: every step, every setting");
  command.option(
      "--uncertainty", options->uncertainty, Values::integers(0, 10'000'000),
      "samples of the parameters in [uncertainty]: bands on the curves, and how well the "
      "errors against printed numbers and --with are known; 0: none");
  return {command, [options] { return compare(*options); }};
}

}  // namespace bentaxis::cli

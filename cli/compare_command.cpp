#include <cstdio>
#include <memory>
#include <optional>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/study/assumptions.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "options.h"
#include "report_files.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

struct Options {
  CaseOption the_case;
  std::string out = "out";
  std::string multibody_case;  // another case for the multibody model; empty = the same
  std::optional<double> tolerance;
  RunChoice choice;
  std::vector<std::string> analytic, multibody;  // KEY=VALUE assumptions
};

int compare(const Options& options) {
  options.choice.refuse_without_effect(true);
  Case first = options.the_case.read();
  std::optional<Case> second;
  if (!options.multibody_case.empty())
    second = CaseOption{options.multibody_case, options.the_case.changes, options.the_case.strict}
                 .read();
  for (const auto& text : options.analytic)
    study::apply_assumption(text, first.pump, first.analytic);
  Case& of_multibody = second ? *second : first;
  for (const auto& text : options.multibody)
    study::apply_assumption(text, of_multibody.pump, of_multibody.multibody);
  if (second) study::check_same_run(first, *second);
  OutputFolder folder(options.out);

  study::ComparisonOptions how;
  how.way = options.choice.way;
  how.tolerance = options.tolerance;
  how.channels = options.choice.channels();
  how.scene = options.choice.scene_for(first);
  how.integration = options.choice.integration;
  if (!options.choice.accuracies.empty()) how.accuracies = options.choice.accuracies;
  how.target = options.choice.target();
  if (const auto data = shipped_reference_data()) how.published = *data / "published";
  const study::ComparisonResult result =
      study::compare_models(std::move(first), std::move(second), how, progress_of);

  const auto wanted = [&](const Channel& channel) { return how.channels.wants(channel); };
  std::vector<TextFile> curves = {
      {"analytic.csv", to_csv(select_channels(result.analytic, wanted))},
      {"multibody.csv", to_csv(select_channels(result.multibody, wanted))}};
  if (result.first.hydraulics)
    curves.emplace_back("pressure.csv", to_csv(result.first.hydraulics->table));
  const auto paths = write_report(folder, "report", study::comparison_document(result, versions()),
                                  report::curves_of(result.analytic, result.multibody), curves);

  std::printf("%s\n", study::comparison_text(result).c_str());
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return result.agrees() ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_compare_command(CommandParser program) {
  auto options = std::make_shared<Options>();
  CommandParser command =
      program.subcommand("compare", "Run both models and report where and by how much they differ");
  add_case(command, options->the_case);
  add_out(command, options->out, "report.html, report.json and the curves");
  command
      .option("--tolerance", options->tolerance,
              "largest difference over peak that counts as agreement")
      .positive_number()
      .text("NUMBER [1e-9 driven, 100 x accuracy integrated]");
  options->choice.add_to(command, true);
  command
      .option("--analytic", options->analytic,
              "assumption of the analytic model: piston_friction=on|off, "
              "inertia=lumped|real|dynamically_equivalent, gear=mesh|imposed; overrides the "
              "case file")
      .text("KEY=VALUE ..");
  command.option("--multibody", options->multibody, "the same for the multibody model")
      .text("KEY=VALUE ..");
  command
      .option("--multibody-case", options->multibody_case,
              "give the multibody model another case, changed by --set alike: what would a "
              "wrong input do?")
      .text("CASE");
  return {command, [options] { return compare(*options); }};
}

}  // namespace bentaxis::cli

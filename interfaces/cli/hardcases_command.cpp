#include "bentaxis/study/hard_cases_document.h"
#include "bentaxis/study/piece_progress.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

constexpr double kLongRunAccuracy = 1e-6;

struct HardcasesOptions {
  std::string out = "out", catalogue, filter;
  int turns = 20;
};

int run(const HardcasesOptions& options) {
  const auto shipped = shipped_reference_data();
  if (options.catalogue.empty() && !shipped)
    throw InputError("no catalogue is installed with this program: name one with --catalogue");
  const std::filesystem::path folder =
      options.catalogue.empty() ? *shipped / "hard" : std::filesystem::path(options.catalogue);
  const auto cases = study::read_catalogue(folder, options.filter);
  ReportFolders folders({options.out, ""});
  study::HardCaseStudy result;
  const Progress progress = progress_of("hard cases");
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (study::HardOutcome& outcome : study::run_hard_case(cases[i], [&](const std::string&) {
           return study::within(progress, i, cases.size());
         }))
      result.runs.push_back({cases[i], std::move(outcome)});
  progress(1);
  if (options.turns > 0 && options.filter.empty())
    result.long_run = study::run_long(folder, options.turns, kLongRunAccuracy, progress_of);
  const auto paths = folders.write("hardcases", study::hard_cases_document(result, versions()), {},
                                   {{"hardcases.csv", study::hard_cases_csv(result)},
                                    {"hardcases.md", study::hard_cases_markdown(result)}});
  std::printf("%s", study::hard_cases_text(result).c_str());
  print_files(paths);
  return result.good() ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_hardcases_command(CommandParser program) {
  auto options = std::make_shared<HardcasesOptions>();
  auto command = program.subcommand(
      "hardcases", "Run the catalogue of hard cases: digits achieved and predicted, refusals");
  add_out(command, options->out, "hardcases.html, .json, .csv and .md");
  command.option("--filter", options->filter, "TEXT", "only cases whose name contains this text");
  command.option(
      "--turns", options->turns, Values::integers(0, 100000),
      "turns of the shaft that are evaluated; of the integrated run. 0 leaves it out, as "
      "--filter does");
  command.option("--catalogue", options->catalogue, "DIR",
                 "folder with another catalogue.toml and its cases");
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli

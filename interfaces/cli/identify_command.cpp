#include <memory>

#include "bentaxis/designs/identify_document.h"
#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"
#include "options.h"
#include "report_files.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

struct IdentifyCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> data, unknowns;
  int seed = 1;
  bool fit_only = false;
  designs::IdentifyOptions identify;
};

int identify(const IdentifyCommandOptions& options, const CommandParser& command) {
  if (options.fit_only)
    for (const char* name : {"--steps", "--draws", "--measured"})
      if (command.given(name))
        throw InputError(std::string(name) + ": has no effect with --fit-only");
  if (designs::least_squares_library().empty())
    throw InputError(
        "identify: this program was built without Ceres; install libceres-dev (scripts/setup full) "
        "and build again");
  const Case base = options.the_case.read();
  designs::IdentificationData data;
  for (const std::string& file : options.data) designs::read_identification(file, base, data);
  for (const std::string& unknown : options.unknowns)
    data.unknowns.push_back(designs::unknown_of("--vary", unknown, base));
  const designs::DataModel model(base, std::move(data));
  ReportFolders folders(options.place);
  designs::IdentifyOptions settings = options.identify;
  settings.seed = static_cast<std::uint64_t>(options.seed);
  if (options.fit_only) settings.posterior = settings.profiles = settings.leave_one_out = false;
  const designs::Identification result = designs::identify(model, settings, progress_of);

  std::vector<TextFile> files = {{"identified.toml", designs::identified_case_text(model, result)},
                                 {"unknowns.csv", designs::unknowns_csv(model, result)}};
  if (const std::string bands = designs::bands_csv(model, result); !bands.empty())
    files.emplace_back("bands.csv", bands);
  const auto paths =
      folders.write("report",
                    designs::identify_document(model, result, versions(),
                                               study::describe(model.base(), progress_of)),
                    {}, files);
  print_result(designs::identify_text(model, result), paths);
  return result.goodness.refuted() ? kOutOfTolerance : kDone;
}

}  // namespace

Command add_identify_command(CommandParser program) {
  auto options = std::make_shared<IdentifyCommandOptions>();
  CommandParser command = program.subcommand(
      "identify", "Determine parameters from printed numbers, windows and records, and how well");
  if (designs::least_squares_library().empty()) command.lacks("Ceres");
  add_case(command, options->the_case);
  add_report(command, options->place,
             "report.html, report.json, identified.toml, unknowns.csv and bands.csv");
  command.option("--data", options->data, "data and unknowns (docs/identification.md)")
      .list()
      .required()
      .text("FILE.toml[,FILE..]");
  command
      .option("--vary", options->unknowns,
              "parameter that varies; with the range in which it is searched, in addition to those "
              "of --data")
      .list()
      .text("NAME=LOW:HIGH[,NAME=LOW:HIGH..]");
  designs::IdentifyOptions& identify_options = options->identify;
  command.option("--starts", identify_options.starts, "starts of the search; the first is the case")
      .integer_in(1, 10000)
      .text("NUMBER [8]");
  command
      .option("--seed", options->seed,
              "seed of the random number generator; of starts and posterior")
      .integer_in(0, 2147483647)
      .text("NUMBER [1]");
  command
      .option("--steps", identify_options.steps,
              "steps of every walker that draws from the posterior; the first half is dropped")
      .integer_in(20, 1000000)
      .text("NUMBER [2000]");
  command.option("--draws", identify_options.draws, "draws that are kept, for the bands")
      .integer_in(10, 100000)
      .text("NUMBER [400]");
  command
      .option("--measured", identify_options.measured,
              "standard uncertainty that a further measurement would have, of the reaction's peak")
      .number_in(1e-6, 1)
      .text("NUMBER [0.01]");
  command.flag("--fit-only", options->fit_only,
               "least squares and their derivatives alone: no profiles, posterior, leaving out");
  add_threads(command, identify_options.threads,
              "at most one per processor; 0: as many. Results do not depend on it");
  return {command, [options, command] { return identify(*options, command); }};
}

}  // namespace bentaxis::cli

#include "bentaxis/designs/identify_document.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct IdentifyCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> data, unknowns;
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
  if (options.fit_only) settings.posterior = settings.profiles = settings.leave_one_out = false;
  const designs::Identification result = designs::identify(model, settings, progress_of);

  std::vector<TextFile> files = {{"identified.toml", designs::identified_case_text(model, result)},
                                 {"unknowns.csv", designs::unknowns_csv(model, result)}};
  if (const std::string bands = designs::bands_csv(model, result); !bands.empty())
    files.emplace_back("bands.csv", bands);
  folders.publish("report", designs::identify_text(model, result),
                  designs::identify_document(model, result, versions(), described(model.base())),
                  files);
  return result.goodness.refuted() ? kOutOfTolerance : kDone;
}

}  // namespace

Command add_identify_command(CommandParser program) {
  auto options = std::make_shared<IdentifyCommandOptions>();
  auto command = program.subcommand(
      "identify", "Determine parameters from printed numbers, windows and records, and how well");
  if (designs::least_squares_library().empty()) command.lacks("Ceres");
  add_case(command, options->the_case);
  add_report(command, options->place,
             "report.html, report.json, identified.toml, unknowns.csv and bands.csv");
  command.option("--data", options->data, Values("FILE.toml[,FILE..]").list().required(),
                 "data and unknowns (docs/identification.md)");
  command.option("--vary", options->unknowns, Values("NAME=LOW:HIGH[,NAME=LOW:HIGH..]").list(),
                 "parameter that varies; with the range in which it is searched, in addition to "
                 "those of --data");
  designs::IdentifyOptions& settings = options->identify;
  command.option("--starts", settings.starts, Values::integers(1, 10000),
                 "starts of the search; the first is the case");
  add_seed(command, settings.seed, "of starts and posterior");
  command.option("--steps", settings.steps, Values::integers(20, 1000000),
                 "steps of every walker that draws from the posterior; the first half is dropped");
  command.option("--draws", settings.draws, Values::integers(10, 100000),
                 "draws that are kept, for the bands");
  command.option(
      "--measured", settings.measured, Values::numbers(1e-6, 1),
      "standard uncertainty that a further measurement would have, of the reaction's peak");
  command.flag("--fit-only", options->fit_only,
               "least squares and their derivatives alone: no profiles, posterior, leaving out");
  add_threads(command, settings.threads,
              "at most one per processor; 0: as many. Results do not depend on it");
  return {command, [options, command] { return identify(*options, command); }};
}

}  // namespace bentaxis::cli

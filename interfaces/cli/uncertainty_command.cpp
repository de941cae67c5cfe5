#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bentaxis/designs/uncertainty_document.h"
#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"
#include "options.h"
#include "report_files.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

constexpr int kMaxSamples = 10'000'000;

struct UncertaintyCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> outputs, varied;  // NAME=DISTRIBUTION
  int samples = 1000, sobol = 0, seed = 1;
  bool no_curves = false;
  designs::UncertaintyOptions uncertainty;
};

// NAME=DISTRIBUTION in the place of what the case says of NAME.
void vary(Case& the_case, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--vary " + text +
                     ": must be NAME=DISTRIBUTION, as in "
                     "pump.tilt_deg=normal(40, 0.1)");
  const std::string name = text.substr(0, equals);
  auto& all = the_case.uncertainty.parameters;
  std::erase_if(all, [&](const UncertaintyData::Parameter& p) { return p.name == name; });
  all.push_back({name, text.substr(equals + 1)});
}

int uncertainty(const UncertaintyCommandOptions& options) {
  Case the_case = options.the_case.read();
  std::set<std::string> varied;
  for (const std::string& text : options.varied) {
    vary(the_case, text);
    if (!varied.insert(the_case.uncertainty.parameters.back().name).second)
      throw InputError("--vary " + text + ": is specified more than once");
  }
  designs::UncertaintyOptions how = options.uncertainty;
  how.samples = static_cast<std::size_t>(options.samples);
  how.sobol = static_cast<std::size_t>(options.sobol);
  how.seed = static_cast<std::uint64_t>(options.seed);
  how.curves = !options.no_curves;
  const std::vector<std::string> usual = {"mean:Td", "peak:Rb1", "peak:Rb2"};
  for (const std::string& name : options.outputs.empty() ? usual : options.outputs)
    how.outputs.push_back(designs::output(name, the_case));
  ReportFolders folders(options.place);
  const designs::UncertaintyResult result = designs::uncertainty(the_case, how, progress_of);

  std::vector<TextFile> files = {{"outputs.csv", designs::outputs_csv(result)},
                                 {"samples.csv", designs::samples_csv(result)}};
  if (!result.bands.empty()) files.emplace_back("bands.csv", designs::bands_csv(result));
  const auto paths =
      folders.write("report",
                    designs::uncertainty_document(result, versions(),
                                                  study::describe(result.the_case, progress_of)),
                    {}, files);
  print_result(designs::uncertainty_text(result), paths);
  return kDone;
}

}  // namespace

Command add_uncertainty_command(CommandParser program) {
  auto options = std::make_shared<UncertaintyCommandOptions>();
  CommandParser command =
      program.subcommand("uncertainty", "Uncertainty of results from distributions of parameters");
  add_case(command, options->the_case);
  add_report(command, options->place,
             "report.html, report.json, outputs.csv, samples.csv and bands.csv");
  command.option("--output", options->outputs, "outputs to compute")
      .list()
      .text("NAME[,NAME..] [mean:Td,peak:Rb1,peak:Rb2]");
  command
      .option("--vary", options->varied,
              "parameter that varies; with its distribution, instead of that in [uncertainty]: "
              "\"pump.tilt_deg=normal(40, 0.1)\"")
      .repeatable()
      .text("NAME=DISTRIBUTION");
  designs::UncertaintyOptions& how = options->uncertainty;
  command.option("--samples", options->samples, "number of samples that are drawn; by Monte Carlo")
      .integer_in(10, kMaxSamples)
      .text("NUMBER [1000]");
  command.option("--seed", options->seed, "seed of the random number generator; of Monte Carlo")
      .integer_in(0, 2'000'000'000)
      .text("NUMBER [1]");
  command.option("--level", how.level, "coverage probability of the bands")
      .number_in(0.01, 0.9999)
      .text("NUMBER [0.95]");
  command
      .option("--sobol", options->sobol,
              "base points of Sobol indices, each of which takes parameters + 2 evaluations; 0: "
              "none")
      .integer_in(0, kMaxSamples)
      .text("NUMBER [0]");
  command.flag("--no-curves", options->no_curves, "numbers only, no bands on reactions");
  command.choice("--model", how.model, {"analytic", "multibody"}, "model that computes");
  add_threads(command, how.threads, "one sample each, at most; 0: one per processor");
  return {command, [options] { return uncertainty(*options); }};
}

}  // namespace bentaxis::cli

#include <set>

#include "bentaxis/designs/uncertainty_document.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

constexpr int kMaxSamples = 10'000'000;

struct UncertaintyCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  std::vector<std::string> outputs, varied;  // NAME=DISTRIBUTION
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
  how.curves = !options.no_curves;
  const std::vector<std::string> usual = {"mean:Td", "peak:Rb1", "peak:Rb2"};
  for (const std::string& name : options.outputs.empty() ? usual : options.outputs)
    how.outputs.push_back(designs::output(name, the_case));
  ReportFolders folders(options.place);
  const designs::UncertaintyResult result = designs::uncertainty(the_case, how, progress_of);

  std::vector<TextFile> files = {{"outputs.csv", designs::outputs_csv(result)},
                                 {"samples.csv", designs::samples_csv(result)}};
  if (!result.bands.empty()) files.emplace_back("bands.csv", designs::bands_csv(result));
  folders.publish("report", designs::uncertainty_text(result),
                  designs::uncertainty_document(result, versions(), described(result.the_case)),
                  files);
  return kDone;
}

}  // namespace

Command add_uncertainty_command(CommandParser program) {
  auto options = std::make_shared<UncertaintyCommandOptions>();
  auto command =
      program.subcommand("uncertainty", "Uncertainty of results from distributions of parameters");
  add_case(command, options->the_case);
  add_report(command, options->place,
             "report.html, report.json, outputs.csv, samples.csv and bands.csv");
  command.option("--output", options->outputs,
                 Values("NAME[,NAME..] [mean:Td,peak:Rb1,peak:Rb2]").list(), "outputs to compute");
  command.option("--vary", options->varied, Values("NAME=DISTRIBUTION").repeated(),
                 "parameter that varies; with its distribution, instead of that in [uncertainty]: "
                 "\"pump.tilt_deg=normal(40, 0.1)\"");
  designs::UncertaintyOptions& how = options->uncertainty;
  command.option("--samples", how.samples, Values::integers(10, kMaxSamples),
                 "number of samples that are drawn; by Monte Carlo");
  add_seed(command, how.seed, "of Monte Carlo", 2'000'000'000);
  command.option("--level", how.level, Values::numbers(0.01, 0.9999),
                 "coverage probability of the bands");
  command.option("--sobol", how.sobol, Values::integers(0, kMaxSamples),
                 "base points of Sobol indices, each of which takes parameters + 2 evaluations; 0: "
                 "none");
  command.flag("--no-curves", options->no_curves, "numbers only, no bands on reactions");
  add_model(command, how.model);
  add_threads(command, how.threads, "one sample each, at most; 0: one per processor");
  return {command, [options] { return uncertainty(*options); }};
}

}  // namespace bentaxis::cli

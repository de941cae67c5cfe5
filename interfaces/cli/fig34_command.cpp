#include <cmath>

#include "bentaxis/study/fig34_document.h"
#include "command_tools.h"
#include "shipped_cases.h"

namespace bentaxis::cli {
namespace {

constexpr double kMicro = 1e-6;

struct Fig34CommandOptions {
  CaseOption the_case;
  ReportPlace place;
  study::Fig34Options study;
  std::vector<double> approaches_um, backlashes_um, block_inertias;  // as the user says them
};

std::vector<double> in_si(std::vector<double> values, const std::string& option, bool zero) {
  for (double& value : values) {
    if (!std::isfinite(value) || value < 0 || (value == 0 && !zero))
      throw InputError(option + ": each value must be finite and " + (zero ? ">= 0" : "> 0"));
    value *= kMicro;
  }
  return values;
}

int run(Fig34CommandOptions& options) {
  if (options.the_case.file.empty())
    options.the_case.file = case_file("bap63_rated", shipped_cases());
  study::Fig34Options& study = options.study;
  study.approaches = in_si(options.approaches_um, "--approaches-um", false);
  if (!options.backlashes_um.empty())
    study.backlashes = in_si(options.backlashes_um, "--backlashes-um", true);
  if (!options.block_inertias.empty())
    study.block_inertias = in_si(options.block_inertias, "--block-inertias-kg-mm2", false);
  const Case as_read = options.the_case.read();
  ReportFolders folders(options.place);
  const study::Fig34Study result = study::run_fig34_study(as_read, study, progress_of);
  folders.publish("fig34", study::fig34_text(result),
                  study::fig34_document(result, versions(), described(result.the_case)),
                  {{"fig34.csv", study::fig34_csv(result)},
                   {"fig34_curves.csv", study::fig34_curves_csv(result)}});
  return kDone;
}

}  // namespace

Command add_fig34_command(CommandParser program) {
  auto options = std::make_shared<Fig34CommandOptions>();
  study::Fig34Options& study = options->study;
  auto command = program.subcommand(
      "fig34", "Contact laws of teeth that are consistent with the paper's Fig. 34");
  add_case(command, options->the_case, "bap63_rated");
  add_report(command, options->place, "fig34.html, fig34.json and the tables");
  const auto list = [](const std::string& usual) {
    return Values("NUMBER[,NUMBER..] [" + usual + "]").list();
  };
  command.option("--exponents", study.exponents, Values::numbers(1, 3).list(),
                 "exponents of the contact law");
  command.option("--approaches-um", options->approaches_um, list("0.5,5,43.3"),
                 "approach of the flanks at 100 N");
  command.option("--backlashes-um", options->backlashes_um, list("0,20,50"),
                 "backlash along the line of action");
  command.option("--dissipations", study.dissipations, Values::numbers(0, 1000).list(),
                 "dissipation of the law, s/m");
  command.option("--block-inertias-kg-mm2", options->block_inertias, list("1000,1500,2000"),
                 "axial inertia of the block");
  command.option("--turns-left-out", study.turns_left_out, Values::integers(0, 1000),
                 "turns after the start that do not count");
  command.option("--windows", study.windows, Values::integers(1, 1000),
                 "windows of two turns each; where they differ, the motion does not repeat");
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli

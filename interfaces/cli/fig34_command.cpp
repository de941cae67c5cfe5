#include <cmath>
#include <memory>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/fig34_document.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "options.h"
#include "report_files.h"
#include "shipped_cases.h"
#include "versions.h"

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
  const auto paths = folders.write(
      "fig34",
      study::fig34_document(result, versions(), study::describe(result.the_case, progress_of)), {},
      {{"fig34.csv", study::fig34_csv(result)},
       {"fig34_curves.csv", study::fig34_curves_csv(result)}});
  print_result(study::fig34_text(result), paths);
  return kDone;
}

}  // namespace

Command add_fig34_command(CommandParser program) {
  auto options = std::make_shared<Fig34CommandOptions>();
  CommandParser command = program.subcommand(
      "fig34", "Contact laws of teeth that are consistent with the paper's Fig. 34");
  add_case(command, options->the_case, "bap63_rated");
  add_report(command, options->place, "fig34.html, fig34.json and the tables");
  command.option("--exponents", options->study.exponents, "exponents of the contact law")
      .list()
      .number_in(1, 3)
      .text("NUMBER[,NUMBER..] [1,1.5,2.2]");
  command.option("--approaches-um", options->approaches_um, "approach of the flanks at 100 N")
      .list()
      .text("NUMBER[,NUMBER..] [0.5,5,43.3]");
  command.option("--backlashes-um", options->backlashes_um, "backlash along the line of action")
      .list()
      .text("NUMBER[,NUMBER..] [0,20,50]");
  command.option("--dissipations", options->study.dissipations, "dissipation of the law, s/m")
      .list()
      .number_in(0, 1000)
      .text("NUMBER[,NUMBER..] [0.05,0.5,5,50]");
  command.option("--block-inertias-kg-mm2", options->block_inertias, "axial inertia of the block")
      .list()
      .text("NUMBER[,NUMBER..] [1000,1500,2000]");
  command
      .option("--turns-left-out", options->study.turns_left_out,
              "turns after the start that do not count")
      .integer_in(0, 1000)
      .text("NUMBER [2]");
  command
      .option("--windows", options->study.windows,
              "windows of two turns each; where they differ, the motion does not repeat")
      .integer_in(1, 1000)
      .text("NUMBER [3]");
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli

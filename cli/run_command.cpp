#include <cstdio>
#include <memory>
#include <string>

#include "bentaxis/pump/files.h"
#include "commands.h"
#include "models.h"
#include "rounding_report.h"

namespace bentaxis::cli {
namespace {

struct Options {
  std::string case_file, model, out = "out";
  Way way = Way::driven;
  std::string scene = "full";
  std::string gear;  ///< "", "mesh" or "imposed"
  multibody::IntegrationOptions integration;
};

int run(const Options& options) {
  const Case the_case = read_case(options.case_file);
  OutputFolder folder(options.out);
  const PressureTrace pressure(the_case.pressure);
  const Way way = options.model == "multibody" ? options.way : Way::driven;
  Assumptions assumptions = options.model == "analytic" ? the_case.analytic : the_case.multibody;
  if (!options.gear.empty())
    assumptions.gear = options.gear == "imposed" ? GearScene::imposed : GearScene::mesh;
  for (const std::string& warning : rounding_warnings(the_case, assumptions))
    std::fprintf(stderr, "bentaxis: warning: %s\n", warning.c_str());
  if (options.model == "analytic") {
    stream_analytic(the_case, assumptions, pressure, folder.open("analytic.csv"));
  } else {
    const ResultTable table =
        run_model(options.model, the_case, assumptions, samples_of(the_case, pressure, way),
                  pressure, way, options.integration);
    folder.add(options.model + ".csv", to_csv(table));
  }
  for (const auto& path : folder.commit()) std::printf("%s\n", path.c_str());
  return kDone;
}

}  // namespace

Command add_run_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("run", "Run one model and write its curves as CSV");
  add_case(*command, options->case_file);
  command->add_option("--model", options->model, "which model")
      ->required()
      ->check(CLI::IsMember({"analytic", "multibody"}))
      ->option_text("analytic|multibody");
  add_out(*command, options->out, "the curves");
  add_way(*command, options->way);
  command->add_option("--scene", options->scene, "multibody: what is built")
      ->check(CLI::IsMember({"full"}))
      ->option_text("full [full]");
  command
      ->add_option("--gear", options->gear,
                   "tooth force between shaft and block, or block speed imposed; overrides the "
                   "case file")
      ->check(CLI::IsMember({"mesh", "imposed"}))
      ->option_text("mesh|imposed [mesh]");
  add_integrator(*command, options->integration);
  command
      ->add_option("--accuracy", options->integration.accuracy,
                   "relative accuracy per step of an integrated run")
      ->check(accuracy_range())
      ->option_text("NUMBER [1e-6]");
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/study/calibration.h"
#include "channel_choice.h"
#include "commands.h"
#include "console.h"
#include "hydraulic_case.h"
#include "models.h"
#include "rounding_report.h"

namespace bentaxis::cli {
namespace {

struct Options {
  std::string case_file, model, out = "out";
  Way way = Way::driven;
  multibody::SceneChoice scene;
  ChannelChoice channels;
  std::string gear;  ///< "", "mesh" or "imposed"
  multibody::IntegrationOptions integration;
  ErrorTarget target;
};

int run(const Options& options) {
  Case the_case = read_case(options.case_file);
  OutputFolder folder(options.out);
  the_case = with_pressure(std::move(the_case)).the_case;
  const PressureTrace pressure(the_case.pressure);
  const Way way = options.model == "multibody" ? options.way : Way::driven;
  Assumptions assumptions = options.model == "analytic" ? the_case.analytic : the_case.multibody;
  if (!options.gear.empty())
    assumptions.gear = options.gear == "imposed" ? BlockDrive::imposed : BlockDrive::mesh;
  if (options.target.error > 0) options.target.refuse_unless(way == Way::integrated);
  const ChannelLayout layout(the_case.pump.geometry.pistons);
  const bool driven = options.model == "multibody" && way == Way::driven;
  const auto wanted = [&](const Channel& channel) { return options.channels.wants(channel); };
  multibody::SceneChoice scene = options.scene;
  if (driven)
    scene = options.channels.scene_for(layout, scene);
  else
    options.channels.of(layout);  // refuses unknown names
  const auto lines = rounding_lines(the_case, assumptions);
  std::vector<std::string> warnings = rounding_warnings(lines);
  if (driven)
    for (auto& text : multibody_warnings(the_case, assumptions, scene, lines))
      warnings.push_back(text);
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "bentaxis: warning: %s\n", warning.c_str());
  if (options.model == "analytic") {
    stream_analytic(the_case, assumptions, pressure, wanted, folder.open("analytic.csv"));
  } else if (options.target.error > 0) {
    const study::VerifiedRun verified =
        study::run_to_error(the_case, assumptions, samples_of(the_case, pressure, way), pressure,
                            options.target.error, options.target.integrators(), progress_of);
    std::fprintf(stderr, "chosen %s\n", verified.text().c_str());
    folder.add("multibody.csv", to_csv(select_channels(verified.run.table, wanted)));
  } else {
    const ResultTable table =
        run_model(options.model, the_case, assumptions, samples_of(the_case, pressure, way),
                  pressure, way, options.integration, nullptr, scene);
    folder.add("multibody.csv", to_csv(select_channels(table, wanted)));
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
  options->channels.add_to(*command, add_scene(*command, options->scene));
  command
      ->add_option("--gear", options->gear,
                   "tooth force between shaft and block, or block speed imposed; overrides the "
                   "case file")
      ->check(CLI::IsMember({"mesh", "imposed"}))
      ->option_text("mesh|imposed [mesh]");
  CLI::Option* integrator = add_integrator(*command, options->integration);
  CLI::Option* accuracy = command
                              ->add_option("--accuracy", options->integration.accuracy,
                                           "relative accuracy per step of an integrated run")
                              ->check(accuracy_range())
                              ->option_text("NUMBER [1e-6]");
  add_error(*command, options->target, options->integration, integrator, accuracy);
  return {command, [options] { return run(*options); }};
}

}  // namespace bentaxis::cli

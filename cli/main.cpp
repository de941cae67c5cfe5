#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string>

#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"

namespace {

using namespace bentaxis;
using namespace bentaxis::cli;

constexpr int kInterruptedStatus = 130;  // as shells report Ctrl-C

void add_way(CLI::App* command, Way& way) {
  command
      ->add_option("--way", way,
                   "multibody: driven (reactions at given angles, no time integration) or "
                   "integrated (in time, over the case's revolutions)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Way>{{"driven", Way::driven}, {"integrated", Way::integrated}}))
      ->option_text("driven|integrated [driven]");
}

void add_integrator(CLI::App* command, multibody::IntegrationOptions& options) {
  std::map<std::string, multibody::Integrator> names;
  std::string list;
  for (std::size_t i = 0; i < multibody::integrator_names().size(); ++i) {
    names[multibody::integrator_names()[i]] = static_cast<multibody::Integrator>(i);
    list += (i == 0 ? "" : "|") + multibody::integrator_names()[i];
  }
  command->add_option("--integrator", options.integrator, "time integrator of an integrated run")
      ->transform(CLI::CheckedTransformer(names))
      ->option_text(list + " [rk-merson]");
}

const CLI::Range kAccuracy(1e-12, 0.1, "in [1e-12, 0.1]");

CLI::App* add_run(CLI::App& app, RunOptions& options) {
  CLI::App* command = app.add_subcommand("run", "Run one model and write its curves as CSV");
  command->add_option("case", options.case_file, "case file (TOML)")->required()->option_text("CASE");
  command->add_option("--model", options.model, "which model")
      ->required()
      ->check(CLI::IsMember({"analytic", "multibody"}))
      ->option_text("analytic|multibody");
  command->add_option("--out", options.out, "folder for the results, made where missing")
      ->option_text("DIR [out]");
  add_way(command, options.way);
  command->add_option("--scene", options.scene, "multibody: what is built")
      ->check(CLI::IsMember({"full"}))
      ->option_text("full [full]");
  command->add_option("--gear", options.gear,
                      "tooth force between shaft and block, or block speed imposed; overrides the "
                      "case file")
      ->check(CLI::IsMember({"mesh", "imposed"}))
      ->option_text("mesh|imposed [mesh]");
  add_integrator(command, options.integration);
  command->add_option("--accuracy", options.integration.accuracy,
                      "relative accuracy per step of an integrated run")
      ->check(kAccuracy)
      ->option_text("NUMBER [1e-6]");
  return command;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& options) {
  CLI::App* command = app.add_subcommand(
      "compare", "Run both models and report where and by how much they differ");
  command->add_option("case", options.case_file, "case file (TOML)")->required()->option_text("CASE");
  command->add_option("--out", options.out, "folder for report.html, report.json and the curves")
      ->option_text("DIR [out]");
  command
      ->add_option("--tolerance", options.tolerance,
                   "largest difference over peak that counts as agreement")
      ->check(CLI::PositiveNumber)
      ->option_text("NUMBER [1e-9 driven, 100 x accuracy integrated]");
  add_way(command, options.way);
  add_integrator(command, options.integration);
  command
      ->add_option("--accuracy", options.accuracies,
                   "accuracies of an integrated run; all are tabled, the last is compared")
      ->delimiter(',')
      ->check(kAccuracy)
      ->option_text("NUMBER[,NUMBER..] [1e-4,1e-6]");
  command
      ->add_option("--analytic", options.analytic,
                   "assumption of the analytic model: piston_friction=on|off, "
                   "inertia=lumped|real, gear=mesh|imposed; overrides the case file")
      ->option_text("KEY=VALUE ..");
  command->add_option("--multibody", options.multibody, "the same for the multibody model")
      ->option_text("KEY=VALUE ..");
  command
      ->add_option("--multibody-case", options.multibody_case,
                   "give the multibody model another case: what would a wrong input do?")
      ->option_text("CASE");
  return command;
}

int guarded(const std::function<int()>& job) {
  try {
    return job();
  } catch (const InputError& error) {
    std::fprintf(stderr, "bentaxis: %s\n", error.what());
    return kBadInput;
  } catch (const Interrupted&) {
    std::fprintf(stderr, "bentaxis: interrupted; nothing was written\n");
    return kInterruptedStatus;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bentaxis: %s\n", error.what());
    return kComputationFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "bentaxis: reaction forces and drive torque of bent-axis piston pumps by two independent "
      "models\n(analytic: closed form after Roccatello & Nervegna 2009; multibody: Simbody), and "
      "how far they are apart.",
      "bentaxis"};
  app.set_version_flag("--version", "bentaxis " BENTAXIS_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 agreed or done, 1 out of tolerance, 2 bad usage or input, 3 computation "
      "failed.\nExample: bentaxis compare cases/bap63_rated.toml --out out");
  RunOptions run;
  CompareOptions compare;
  const CLI::App* run_app = add_run(app, run);
  add_compare(app, compare);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "bentaxis: %s (see bentaxis --help)\n", error.what());
    return kBadInput;
  }
  if (compare.accuracies.empty()) compare.accuracies = {1e-4, 1e-6};
  watch_for_interruption();
  return guarded([&] { return run_app->parsed() ? run_command(run) : compare_command(compare); });
}

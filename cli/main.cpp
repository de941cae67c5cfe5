#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <iostream>
#include <vector>

#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"

namespace {

using namespace bentaxis;
using namespace bentaxis::cli;

constexpr int kInterruptedStatus = 130;  // as shells report Ctrl-C

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

// What was printed is a result: if it did not arrive, the job is not done.
int checked_output(int status) {
  errno = 0;
  std::cout.flush();
  const bool arrived = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  if (arrived || status == kBadInput || status == kComputationFailed) return status;
  std::fprintf(stderr, "bentaxis: standard output cannot be written%s%s\n", errno != 0 ? ": " : "",
               errno != 0 ? std::strerror(errno) : "");
  return kBadInput;
}

int run_program(int argc, char** argv) {
  CLI::App app{
      "bentaxis: reaction forces and drive torque of bent-axis piston pumps by two independent "
      "models\n(analytic: closed form after Roccatello & Nervegna 2009; multibody: Simbody), and "
      "how far they are apart.",
      "bentaxis"};
  app.set_version_flag("--version", "bentaxis " BENTAXIS_VERSION);
  app.require_subcommand(0, 1);
  app.footer(
      "Exit status: 0 agreed or done, 1 out of tolerance, 2 bad usage or input, 3 computation "
      "failed.\nExample: bentaxis compare cases/bap63_rated.toml --out out");
  const std::vector<Command> commands = {
      add_run_command(app),       add_compare_command(app),    add_regress_command(app),
      add_reference_command(app), add_hardcases_command(app),  add_inertia_command(app),
      add_pressure_command(app),  add_tradeoff_command(app),   add_schema_command(app),
      add_calibrate_command(app), add_blocktorque_command(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "bentaxis: %s (see bentaxis --help)\n", error.what());
    return kBadInput;
  }
  watch_for_interruption();
  for (const Command& command : commands)
    if (command.parser->parsed()) return guarded(command.run);
  std::fprintf(stderr, "bentaxis: a command is needed, such as compare (see bentaxis --help)\n");
  return kBadInput;
}

}  // namespace

int main(int argc, char** argv) { return checked_output(run_program(argc, argv)); }

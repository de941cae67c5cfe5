#include "commands.h"
namespace bentaxis::cli {
Command add_reference_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("reference", "Make and update reference data");
  return {command, [] { return 0; }};
}
}  // namespace bentaxis::cli

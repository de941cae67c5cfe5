// The commands of the program, one per job and file.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace bentaxis::cli {

/// Exit statuses (docs/command_line.md).
enum ExitStatus { kDone = 0, kOutOfTolerance = 1, kBadInput = 2, kComputationFailed = 3 };

/// A command as the parser knows it, and what it does once its options are parsed.
struct Command {
  CLI::App* parser;
  std::function<int()> run;  ///< returns the exit status
};

Command add_run_command(CLI::App& app);
Command add_blocktorque_command(CLI::App& app);
Command add_calibrate_command(CLI::App& app);
Command add_compare_command(CLI::App& app);
Command add_hardcases_command(CLI::App& app);
Command add_inertia_command(CLI::App& app);
Command add_pressure_command(CLI::App& app);
Command add_regress_command(CLI::App& app);
Command add_reference_command(CLI::App& app);
Command add_schema_command(CLI::App& app);
Command add_tradeoff_command(CLI::App& app);

}  // namespace bentaxis::cli

// The commands of the program, one per job and file.
#pragma once

#include <functional>
#include <string>

#include "command_parser.h"

namespace bentaxis::cli {

/// Exit statuses (docs/command_line.md).
enum ExitStatus {
  kDone = 0,
  kOutOfTolerance = 1,
  kBadInput = 2,
  kComputationFailed = 3,
  kInterrupted = 130,  ///< as shells report Ctrl-C
};

/// A command as the parser knows it, and what it does once its options are parsed.
struct Command {
  CommandParser parser;
  std::function<int()> run;  ///< returns the exit status
};

// The first program (scripts/compare_default_pump) has some of these only as names: see there.
Command add_run_command(CommandParser program);
Command add_blocktorque_command(CommandParser program);
Command add_calibrate_command(CommandParser program);
Command add_cases_command(CommandParser program);
Command add_completion_command(CommandParser program);
Command add_compare_command(CommandParser program);
Command add_docs_command(CommandParser program);
Command add_fig34_command(CommandParser program);
Command add_fmu_command(CommandParser program);
Command add_hardcases_command(CommandParser program);
Command add_identify_command(CommandParser program);
Command add_init_command(CommandParser program);
Command add_index_command(CommandParser program);
Command add_inertia_command(CommandParser program);
Command add_licenses_command(CommandParser program);
Command add_life_command(CommandParser program);
Command add_manual_command(CommandParser program);
Command add_merge_command(CommandParser program);
Command add_optimise_command(CommandParser program);
Command add_outputs_command(CommandParser program);
Command add_paper_command(CommandParser program);
Command add_pressure_command(CommandParser program);
Command add_problems_command(CommandParser program);
Command add_rattle_command(CommandParser program);
Command add_uncertainty_command(CommandParser program);
Command add_regress_command(CommandParser program);
Command add_reference_command(CommandParser program);
Command add_schema_command(CommandParser program);
Command add_score_command(CommandParser program);
Command add_show_command(CommandParser program);
Command add_sensitivity_command(CommandParser program);
Command add_simulate_command(CommandParser program);
Command add_sweep_command(CommandParser program);
Command add_tradeoff_command(CommandParser program);

}  // namespace bentaxis::cli

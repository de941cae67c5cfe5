#include <map>
#include <string>
#include <utility>

#include "commands.h"

namespace bentaxis::cli {

Command add_further_command(CommandParser program, const std::string& name) {
  static const std::map<std::string, Command (*)(CommandParser)> all = {
      {"blocktorque", add_blocktorque_command},
      {"calibrate", add_calibrate_command},
      {"fig34", add_fig34_command},
      {"fmu", add_fmu_command},
      {"hardcases", add_hardcases_command},
      {"identify", add_identify_command},
      {"inertia", add_inertia_command},
      {"init", add_init_command},
      {"life", add_life_command},
      {"merge", add_merge_command},
      {"optimise", add_optimise_command},
      {"outputs", add_outputs_command},
      {"paper", add_paper_command},
      {"pressure", add_pressure_command},
      {"problems", add_problems_command},
      {"rattle", add_rattle_command},
      {"reference", add_reference_command},
      {"regress", add_regress_command},
      {"score", add_score_command},
      {"sensitivity", add_sensitivity_command},
      {"simulate", add_simulate_command},
      {"sweep", add_sweep_command},
      {"tradeoff", add_tradeoff_command},
      {"uncertainty", add_uncertainty_command},
  };
  return all.at(name)(std::move(program));
}

}  // namespace bentaxis::cli

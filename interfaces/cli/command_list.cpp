#include "command_list.h"

namespace bentaxis::cli {
namespace {

struct Listed {
  Command (*add)(CommandParser program);
  const char* example;
};

struct Group {
  const char* title;
  std::vector<Listed> commands;
};

// Examples can be tried in an empty directory in this order: tests/words_test.py runs them.
const std::vector<Group>& groups() {
  static const std::vector<Group> all = {
      {"Compare and report",
       {{add_compare_command, "bentaxis compare bap63_rated --out out"},
        {add_show_command, "bentaxis show bap63_rated --out pump.svg"},
        {add_regress_command, "bentaxis regress --filter standstill --out regress"},
        {add_hardcases_command, "bentaxis hardcases --filter tilt_45 --out hardcases"},
        {add_tradeoff_command,
         "bentaxis tradeoff bap63_rated --accuracies 1e-3 --max-seconds-per-run 1 --out tradeoff"},
        {add_score_command,
         "bentaxis score out/analytic.csv --problem pump_lumped    # after: bentaxis compare "
         "bap63_rated"},
        {add_index_command, "bentaxis index ."}}},
      {"Simulate",
       {{add_run_command, "bentaxis run bap63_rated --model analytic --channels Rs,Td --out run"},
        {add_simulate_command, "bentaxis simulate bap63_motor_start --out simulate"},
        {add_pressure_command, "bentaxis pressure bap63_rated_hydraulic --out pressure"},
        {add_inertia_command, "bentaxis inertia bap63_rated --speeds 1500 --map-size 2"},
        {add_life_command, "bentaxis life bap63_bearing_life --set pressure.kind=ideal"}}},
      {"Study many designs",
       {{add_sweep_command,
         "bentaxis sweep bap63_rated --vary pump.tilt_deg=35:40:1 --output peak:Rb1 --out sweep"},
        {add_merge_command,
         "for i in 1 2; do\n"
         "    bentaxis sweep bap63_rated --vary pump.tilt_deg=35:40:1 --output peak:Rb1 --part "
         "$i/2 --out parts\n"
         "  done\n"
         "  bentaxis merge parts"},
        {add_optimise_command,
         "bentaxis optimise bap63_rated --vary pump.tilt_deg=30:42 --minimise peak:Rb1 "
         "--maximise displacement_cm3 --generations 5 --out optimise"},
        {add_sensitivity_command,
         "bentaxis sensitivity bap63_rated --output peak:Rb1 --vary pump.tilt_deg"},
        {add_uncertainty_command,
         "bentaxis uncertainty bap63_rated --vary \"pump.tilt_deg=normal(40, 0.1)\" --samples 200"},
        {add_identify_command,
         "printf '%s\\n' 'schema = 1' '[[unknown]]' 'parameter = \"pressure.delivery_bar\"' "
         "'between = [200, "
         "350]' \\\n"
         "    '[[number]]' 'output = \"mean:Td\"' 'value = 294.7' 'uncertainty = 0.5' > data.toml\n"
         "  bentaxis identify bap63_rated --data data.toml --fit-only"},
        {add_rattle_command,
         "bentaxis rattle bap63_tooth_rattle --speeds 1000,1500 --delivery-bar 100:200:100"},
        {add_outputs_command, "bentaxis outputs bap63_rated"}}},
      {"Data in and out",
       {{add_cases_command, "bentaxis cases"},
        {add_problems_command, "bentaxis problems"},
        {add_init_command, "bentaxis init my_pump --case bap63_rated"},
        {add_reference_command, "bentaxis reference golden bap63_rated --out golden"},
        {add_fmu_command, "bentaxis fmu bap63_rated --out pump.fmu"},
        {add_schema_command, "bentaxis schema > case.schema.json"},
        {add_docs_command, "bentaxis docs --print    # after: scripts/build_site"},
        {add_licenses_command, "bentaxis licenses SUNDIALS"},
        {add_completion_command, "source <(bentaxis completion bash)"},
        {add_manual_command, "bentaxis manual | man -l -"}}},
      {"The paper",
       {{add_paper_command, "bentaxis paper --out paper"},
        {add_fig34_command, "bentaxis fig34 --exponents 1.5 --dissipations 0.5 --out fig34"},
        {add_blocktorque_command, "bentaxis blocktorque bap63_rated bap63_rated_hydraulic"},
        {add_calibrate_command,
         "bentaxis calibrate bap63_rated --torque-with-friction 294.7 "
         "--torque-without-friction 293.4"}}}};
  return all;
}

void add_former_names(ProgramParser& program) {
  program.renamed("calibrate", "--with", "--torque-with-friction");
  program.renamed("calibrate", "--without", "--torque-without-friction");
  program.renamed("fmu", "--tolerance", "--accuracy");
  program.renamed("identify", "--unknown", "--vary");
  program.renamed("rattle", "--check", "--check-points");
  program.renamed("reference golden", "--samples", "--angles");
  program.renamed("regress", "--json", "--json-file");
  program.renamed("sensitivity", "--check", "--check-derivatives");
  program.renamed("sensitivity", "--parameter", "--vary");
  program.renamed("tradeoff", "--samples", "--angles");
}

}  // namespace

std::vector<Command> add_commands(ProgramParser& program) {
  std::vector<Command> commands;
  for (const Group& group : groups())
    for (const Listed& listed : group.commands) {
      commands.push_back(listed.add(program.root()));
      commands.back().parser.place(group.title, listed.example);
    }
  add_former_names(program);
  return commands;
}

}  // namespace bentaxis::cli

#include "command_list.h"

#include <functional>
#include <utility>

namespace bentaxis::cli {
namespace {

struct Listed {
  std::function<Command(CommandParser)> add;
  const char* example;
};

// What the first program lacks.
std::function<Command(CommandParser)> further(const char* name) {
  return [name](CommandParser program) { return add_further_command(std::move(program), name); };
}

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
        {further("regress"), "bentaxis regress --filter standstill --out regress"},
        {further("hardcases"), "bentaxis hardcases --filter zero_tilt --out hardcases"},
        {further("tradeoff"),
         "bentaxis tradeoff bap63_rated --accuracies 1e-3 --max-seconds-per-run 1 --out tradeoff"},
        {further("score"),
         "bentaxis score out/analytic.csv --problem pump_lumped    # after: bentaxis compare "
         "bap63_rated"},
        {add_index_command, "bentaxis index ."}}},
      {"Simulate",
       {{add_run_command, "bentaxis run bap63_rated --model analytic --channels Rs,Td --out run"},
        {further("simulate"), "bentaxis simulate bap63_motor_start --out simulate"},
        {further("pressure"), "bentaxis pressure bap63_rated_hydraulic --out pressure"},
        {further("inertia"), "bentaxis inertia bap63_rated --speeds 1500 --map-size 2"},
        {further("life"), "bentaxis life bap63_bearing_life --set pressure.kind=ideal"}}},
      {"Study many designs",
       {{further("sweep"),
         "bentaxis sweep bap63_rated --vary pump.tilt_deg=35:40:1 --output peak:Rb1 --out sweep"},
        {further("merge"), "bentaxis merge parts    # after: bentaxis sweep .. --part I/N"},
        {further("optimise"),
         "bentaxis optimise bap63_rated --vary pump.tilt_deg=30:42 --minimise peak:Rb1 "
         "--maximise displacement_cm3 --generations 5 --out optimise"},
        {further("sensitivity"),
         "bentaxis sensitivity bap63_rated --output peak:Rb1 --vary pump.tilt_deg"},
        {further("uncertainty"),
         "bentaxis uncertainty bap63_rated --vary \"pump.tilt_deg=normal(40, 0.1)\" --samples 100"},
        {further("identify"), "bentaxis identify my.toml --data data.toml --fit-only"},
        {further("rattle"),
         "bentaxis rattle bap63_tooth_rattle --speeds 1000,1500 --delivery-bar 100:200:100"},
        {further("outputs"), "bentaxis outputs bap63_rated"}}},
      {"Data in and out",
       {{add_cases_command, "bentaxis cases"},
        {further("problems"), "bentaxis problems"},
        {further("init"), "bentaxis init my_pump --case bap63_rated"},
        {further("reference"), "bentaxis reference golden bap63_rated --out golden"},
        {further("fmu"), "bentaxis fmu bap63_rated --out pump.fmu"},
        {add_schema_command, "bentaxis schema > case.schema.json"},
        {add_docs_command, "bentaxis docs --print    # after: scripts/build_site"},
        {add_licenses_command, "bentaxis licenses SUNDIALS"},
        {add_completion_command, "source <(bentaxis completion bash)"},
        {add_manual_command, "bentaxis manual | man -l -"}}},
      {"The paper",
       {{further("paper"), "bentaxis paper --out paper"},
        {further("fig34"), "bentaxis fig34 --exponents 1.5 --dissipations 0.5 --out fig34"},
        {further("blocktorque"), "bentaxis blocktorque bap63_rated bap63_rated_hydraulic"},
        {further("calibrate"),
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

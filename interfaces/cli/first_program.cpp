// The first program (scripts/compare_default_pump): what is not built with it is listed, and says
// how to build it.
#include "bentaxis/pump/error.h"
#include "bentaxis/study/engine_comparison.h"
#include "commands.h"
#include "compare_parts.h"
#include "versions.h"

namespace bentaxis {

namespace cli {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(what + " is not built yet: run scripts/build (it takes some minutes)");
}

Command not_built(CommandParser program, const std::string& name) {
  auto command = program.subcommand(name, "(not built yet: scripts/build)");
  command.accept_anything();
  return {command, [name]() -> int { refuse(name); }};
}

}  // namespace

// NOLINTBEGIN(performance-unnecessary-value-param): a table of names, copied once
Command add_blocktorque_command(CommandParser program) { return not_built(program, "blocktorque"); }
Command add_calibrate_command(CommandParser program) { return not_built(program, "calibrate"); }
Command add_fig34_command(CommandParser program) { return not_built(program, "fig34"); }
Command add_fmu_command(CommandParser program) { return not_built(program, "fmu"); }
Command add_hardcases_command(CommandParser program) { return not_built(program, "hardcases"); }
Command add_identify_command(CommandParser program) { return not_built(program, "identify"); }
Command add_inertia_command(CommandParser program) { return not_built(program, "inertia"); }
Command add_init_command(CommandParser program) { return not_built(program, "init"); }
Command add_life_command(CommandParser program) { return not_built(program, "life"); }
Command add_merge_command(CommandParser program) { return not_built(program, "merge"); }
Command add_optimise_command(CommandParser program) { return not_built(program, "optimise"); }
Command add_outputs_command(CommandParser program) { return not_built(program, "outputs"); }
Command add_paper_command(CommandParser program) { return not_built(program, "paper"); }
Command add_pressure_command(CommandParser program) { return not_built(program, "pressure"); }
Command add_problems_command(CommandParser program) { return not_built(program, "problems"); }
Command add_rattle_command(CommandParser program) { return not_built(program, "rattle"); }
Command add_reference_command(CommandParser program) { return not_built(program, "reference"); }
Command add_regress_command(CommandParser program) { return not_built(program, "regress"); }
Command add_score_command(CommandParser program) { return not_built(program, "score"); }
Command add_sensitivity_command(CommandParser program) { return not_built(program, "sensitivity"); }
Command add_simulate_command(CommandParser program) { return not_built(program, "simulate"); }
Command add_sweep_command(CommandParser program) { return not_built(program, "sweep"); }
Command add_tradeoff_command(CommandParser program) { return not_built(program, "tradeoff"); }
Command add_uncertainty_command(CommandParser program) { return not_built(program, "uncertainty"); }
// NOLINTEND(performance-unnecessary-value-param)

void require_whole_program(const std::string& option) { refuse(option); }

std::vector<std::string> engine_names() { return {}; }

void explain_differences(study::Outcome&, const Case&, const study::PartProgress&) {
  refuse("--with");
}

void check_sampling(const Case&, std::size_t) { refuse("--uncertainty"); }

KnownHowWell add_uncertainty(report::Document&, const Case&, const study::ComparisonResult&,
                             std::size_t, const study::PartProgress&) {
  refuse("--uncertainty");
}

Lines versions() { return shared_versions(); }

std::string optional_parts() { return "not built yet (scripts/build)"; }

}  // namespace cli

const study::EngineCalls study::kEngineCalls = {
    [](const EngineOptions&) { cli::refuse("--engine"); },
    [](const PreparedCase&, const EngineOptions&, const ResultTable&, const ResultTable*, double,
       const PartProgress&) -> EngineComparison { cli::refuse("--engine"); }};

}  // namespace bentaxis

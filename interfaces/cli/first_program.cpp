// The first program (scripts/compare_default_pump): what is not built with it is listed, and says
// how to build it.
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/engine_comparison.h"
#include "commands.h"
#include "compare_parts.h"
#include "versions.h"

namespace bentaxis {

namespace cli {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(what + " is not built yet: scripts/build, which takes some minutes, builds it");
}

Command not_built(CommandParser program, const std::string& name) {
  CommandParser command = program.subcommand(name, "(not built yet: scripts/build)");
  command.accept_anything();
  return {command, [name]() -> int { refuse(name); }};
}

}  // namespace

Command add_blocktorque_command(CommandParser program) {
  return not_built(std::move(program), "blocktorque");
}
Command add_calibrate_command(CommandParser program) {
  return not_built(std::move(program), "calibrate");
}
Command add_fig34_command(CommandParser program) { return not_built(std::move(program), "fig34"); }
Command add_fmu_command(CommandParser program) { return not_built(std::move(program), "fmu"); }
Command add_hardcases_command(CommandParser program) {
  return not_built(std::move(program), "hardcases");
}
Command add_identify_command(CommandParser program) {
  return not_built(std::move(program), "identify");
}
Command add_inertia_command(CommandParser program) {
  return not_built(std::move(program), "inertia");
}
Command add_init_command(CommandParser program) { return not_built(std::move(program), "init"); }
Command add_life_command(CommandParser program) { return not_built(std::move(program), "life"); }
Command add_merge_command(CommandParser program) { return not_built(std::move(program), "merge"); }
Command add_optimise_command(CommandParser program) {
  return not_built(std::move(program), "optimise");
}
Command add_outputs_command(CommandParser program) {
  return not_built(std::move(program), "outputs");
}
Command add_paper_command(CommandParser program) { return not_built(std::move(program), "paper"); }
Command add_pressure_command(CommandParser program) {
  return not_built(std::move(program), "pressure");
}
Command add_problems_command(CommandParser program) {
  return not_built(std::move(program), "problems");
}
Command add_rattle_command(CommandParser program) {
  return not_built(std::move(program), "rattle");
}
Command add_reference_command(CommandParser program) {
  return not_built(std::move(program), "reference");
}
Command add_regress_command(CommandParser program) {
  return not_built(std::move(program), "regress");
}
Command add_score_command(CommandParser program) { return not_built(std::move(program), "score"); }
Command add_sensitivity_command(CommandParser program) {
  return not_built(std::move(program), "sensitivity");
}
Command add_simulate_command(CommandParser program) {
  return not_built(std::move(program), "simulate");
}
Command add_sweep_command(CommandParser program) { return not_built(std::move(program), "sweep"); }
Command add_tradeoff_command(CommandParser program) {
  return not_built(std::move(program), "tradeoff");
}
Command add_uncertainty_command(CommandParser program) {
  return not_built(std::move(program), "uncertainty");
}

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

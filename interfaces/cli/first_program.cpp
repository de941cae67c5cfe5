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

}  // namespace

Command add_further_command(CommandParser program, const std::string& name) {
  CommandParser command = program.subcommand(name, "(not built yet: scripts/build)");
  command.accept_anything();
  return {command, [name]() -> int { refuse(name); }};
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

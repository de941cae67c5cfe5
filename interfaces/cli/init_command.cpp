#include "bentaxis/study/project.h"
#include "command_tools.h"
#include "shipped_cases.h"

namespace bentaxis::cli {
namespace {

struct InitOptions {
  CaseOption the_case;
  std::string folder;
  std::string ci = "both";
};

int init(const InitOptions& options) {
  CaseOption wanted = options.the_case;
  if (wanted.file.empty()) wanted.file = case_file("bap63_rated", shipped_cases());
  const auto chosen = [&](const char* system) {
    return options.ci == "both" || options.ci == system;
  };
  const auto files =
      study::make_project(wanted.read(), !wanted.changes.empty(),
                          {chosen("github"), chosen("gitlab")}, options.folder, progress_of);
  for (const auto& file : files) std::printf("%s\n", file.c_str());
  std::printf("now: cd %s && bentaxis regress reference\n", options.folder.c_str());
  return kDone;
}

}  // namespace

Command add_init_command(CommandParser program) {
  auto options = std::make_shared<InitOptions>();
  auto command = program.subcommand(
      "init", "Write a project: a case, a reference made from it, job files for CI, a README");
  command.option("dir", options->folder, Values("DIR").required(), "new folder");
  command.option("--case", options->the_case.file, Values::case_file("CASE [bap63_rated]"),
                 "case file (TOML), or the name of a shipped case (bentaxis cases)");
  add_changes(command, options->the_case);
  command.option(
      "--ci", options->ci,
      Values::words({"both", "github", "gitlab", "none"}, "both|github|gitlab|none [both]"),
      "for which CI systems a job file is written");
  return {command, [options] { return init(*options); }};
}

}  // namespace bentaxis::cli

#include "command_tools.h"
#include "score_files.h"

namespace bentaxis::cli {
namespace {

int list_problems(bool json) {
  const auto folder = shipped_problems();
  if (!folder) throw InputError("no problems are installed with this program");
  std::vector<study::Problem> problems;
  for (const std::string& name : study::problem_names(*folder))
    problems.push_back(study::read_problem(*folder / name));
  if (json) {
    std::fputs(problems_json(problems).c_str(), stdout);
    return kDone;
  }
  std::printf(
      "%s\nbentaxis score takes the name: bentaxis score FILE --problem pendulum\n"
      "Folders: %s/NAME; text: problem.md, data: problem.toml, curves: curves.csv\n",
      problems_text(problems).c_str(), folder->c_str());
  return kDone;
}

}  // namespace

Command add_problems_command(CommandParser program) {
  const auto json = std::make_shared<bool>(false);
  auto command = program.subcommand(
      "problems", "List the problems of the problem set, which `score` compares results with");
  command.flag("--json", *json, "print JSON instead of text");
  return {command, [json] { return list_problems(*json); }};
}

}  // namespace bentaxis::cli

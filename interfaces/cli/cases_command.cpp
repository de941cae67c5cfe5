#include "command_tools.h"
#include "shipped_cases.h"

namespace bentaxis::cli {
namespace {

int list_cases(bool json) {
  const auto folder = shipped_cases();
  if (!folder) throw InputError("no cases are installed with this program");
  const std::vector<ShippedCase> cases = cases_in(*folder);
  if (json) {
    std::fputs(cases_json(cases).c_str(), stdout);
    return kDone;
  }
  std::printf("%s\nA command takes the name as CASE: bentaxis compare bap63_rated\nFiles: %s\n",
              cases_text(cases).c_str(), folder->c_str());
  return kDone;
}

}  // namespace

Command add_cases_command(CommandParser program) {
  const auto json = std::make_shared<bool>(false);
  auto command = program.subcommand("cases", "List the cases that come with the program");
  command.flag("--json", *json, "print JSON instead of text");
  return {command, [json] { return list_cases(*json); }};
}

}  // namespace bentaxis::cli

#include "command_tools.h"
#include "licences.h"

namespace bentaxis::cli {

Command add_licenses_command(CommandParser program) {
  const auto part = std::make_shared<std::string>();
  auto command = program.subcommand(
      "licenses", "List the parts of other projects in bentaxis, or print the licence of one");
  std::vector<std::string> names = {"bentaxis"};
  for (const Part& one : parts()) names.push_back(one.name);
  command.option("part", *part, Values("[PART]").completed_with(names),
                 "a part, as SUNDIALS; without: the list of all");
  return {command, [part] {
            std::fputs((part->empty() ? parts_text() : licence_text(*part)).c_str(), stdout);
            return kDone;
          }};
}

}  // namespace bentaxis::cli

// bentaxis outputs: the numbers of a case that studies can be asked for.
#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/designs/output.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

constexpr const char* kHead =
    "STATISTIC:NAME over the turn: mean, min, max, peak (largest magnitude), rms or range.\n"
    "A name that ends with a piston's number stands for that piston: Rs_3 for piston 3.\n";

void print(const std::vector<designs::Output>& outputs) {
  std::size_t names = 0, units = 0;
  for (const designs::Output& o : outputs) {
    names = std::max(names, o.name.size());
    units = std::max(units, o.unit.size());
  }
  std::string text = kHead;
  text += "\n";
  for (const designs::Output& o : outputs)
    text += fmt::format("{:<{}}  {:<{}}  {}\n", o.name, names, o.unit, units, o.meaning);
  std::fputs(text.c_str(), stdout);
}

int outputs(const CaseOption& option) {
  const Case the_case = option.read();
  std::vector<designs::Output> all;
  for (const std::string& name : designs::output_names(the_case))
    all.push_back(designs::output(name, the_case));
  print(all);
  return kDone;
}

}  // namespace

Command add_outputs_command(CommandParser program) {
  auto the_case = std::make_shared<CaseOption>();
  auto command = program.subcommand("outputs",
                                    "List the numbers that sweep, optimise, sensitivity "
                                    "and uncertainty can be asked for (--output), with "
                                    "units and meanings");
  add_case(command, *the_case);
  return {command, [the_case] { return outputs(*the_case); }};
}

}  // namespace bentaxis::cli

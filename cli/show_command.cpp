// bentaxis show: the pump of a case, before anything is computed.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/pump_picture.h"
#include "commands.h"
#include "options.h"

namespace bentaxis::cli {
namespace {

struct Options {
  CaseOption the_case;
  std::string out;
};

int show(const Options& options) {
  const Case the_case = options.the_case.read();
  std::printf("%s\n", the_case.name.c_str());
  for (const auto& quantity : study::derived_section(the_case))
    std::printf("  %-22s %10.5g %s\n", quantity.name.c_str(), quantity.value,
                quantity.unit.c_str());
  if (options.out.empty()) return kDone;
  const auto path = std::filesystem::absolute(options.out);
  OutputFolder folder(path.parent_path());
  folder.add(path.filename(), study::pump_picture(the_case));
  folder.commit();
  std::printf("%s\n", options.out.c_str());
  return kDone;
}

}  // namespace

Command add_show_command(CommandParser program) {
  auto options = std::make_shared<Options>();
  CommandParser command = program.subcommand(
      "show", "Say what pump a case describes and what of it is doubtful, and draw it to scale");
  add_case(command, options->the_case);
  command.option("--out", options->out, "write the picture").text("FILE.svg");
  return {command, [options] { return show(*options); }};
}

}  // namespace bentaxis::cli

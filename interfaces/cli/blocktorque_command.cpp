#include "bentaxis/study/block_torque.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct BlocktorqueOptions {
  CaseOption the_case;
  std::string hydraulic;
};

int blocktorque(const BlocktorqueOptions& options) {
  const auto rows = study::block_torques(
      options.the_case.read(),
      CaseOption{options.hydraulic, options.the_case.changes, options.the_case.strict}.read(),
      progress_of);
  std::printf("%s", study::block_torque_text(rows).c_str());
  return kDone;
}

}  // namespace

Command add_blocktorque_command(CommandParser program) {
  auto options = std::make_shared<BlocktorqueOptions>();
  auto command = program.subcommand(
      "blocktorque",
      "Explain the paper's torque from shaft to block against ADAMS: one change at a time");
  add_case(command, options->the_case);
  command.option("hydraulic", options->hydraulic, Values::case_file("HYDRAULIC_CASE").required(),
                 "the same pump with the hydraulic model, changed by --set alike");
  return {command, [options] { return blocktorque(*options); }};
}

}  // namespace bentaxis::cli

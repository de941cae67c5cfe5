#include "bentaxis/study/friction_calibration.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct CalibrateOptions {
  CaseOption the_case;
  study::MeanTorques wanted;  // Nm
};

int calibrate(const CalibrateOptions& options) {
  for (const auto& step :
       study::calibrate_friction(options.the_case.read(), options.wanted, progress_of))
    std::printf(
        "piston_coulomb_N = %.6g, shaft_torque_factor = %.6g: %.4f Nm with, %.4f Nm without piston "
        "friction\n",
        step.piston_coulomb, step.torque_factor, step.torques.with_friction,
        step.torques.without_friction);
  return kDone;
}

}  // namespace

Command add_calibrate_command(CommandParser program) {
  auto options = std::make_shared<CalibrateOptions>();
  auto command = program.subcommand(
      "calibrate", "Find the piston friction and shaft losses that give two mean torques");
  add_case(command, options->the_case);
  const Values torque = Values::positive("NUMBER").required();
  command.option("--torque-with-friction", options->wanted.with_friction, torque,
                 "mean drive torque wanted with piston friction, Nm");
  command.option("--torque-without-friction", options->wanted.without_friction, torque,
                 "the same without piston friction");
  return {command, [options] { return calibrate(*options); }};
}

}  // namespace bentaxis::cli

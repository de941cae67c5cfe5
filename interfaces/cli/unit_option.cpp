#include "unit_option.h"

#include "bentaxis/pump/error.h"
#include "console.h"

namespace bentaxis::cli {

void UnitOption::add_to(CommandParser command) {
  command.option(
      "--fmu", file_, "FILE",
      "a drive or load as a Functional Mock-up Unit (FMI 2.0 or 3.0, co-simulation) that acts on "
      "the pump; each model has its own instance");
  command.option("--fmu-set", choice_.parameters, Values("NAME=VALUE").repeated(),
                 "a parameter of the FMU, in its declared unit of measure");
  command.option(
      "--connect", choice_.connect, Values("A=B").repeated(),
      "an input of the pump (A) gets the value of an output of the FMU (B), or an input of the FMU "
      "(A) that of a column of the CSV files (B). Inputs of the pump: drive_speed, "
      "drive_acceleration, drive_torque, suction_pressure, delivery_pressure, load_share. Equal "
      "names are always connected. Where both sides have A and B: pump:A=B or fmu:A=B, for the "
      "input of the pump or of the FMU");
  command.option("--communication-step", choice_.step,
                 Values::positive("SECONDS [that of the FMU, or between rows]"),
                 "s between the points at which pump and FMU exchange values");
  command.option("--fmu-timeout", choice_.limits.call_seconds,
                 Values::numbers(0, 1e6, "SECONDS [60]"),
                 "s: the maximum elapsed time of one call of a function of the FMU; 0: no limit");
}

std::shared_ptr<const study::UnitCoupling> UnitOption::coupling(const CommandParser& command,
                                                                const Case& the_case,
                                                                bool oil_follows) const {
  for (const char* option : {"--fmu-set", "--connect", "--communication-step", "--fmu-timeout"})
    if (command.given(option) && !given())
      throw InputError(std::string(option) + ": has no effect without --fmu");
  if (!given()) return nullptr;
  study::UnitChoice choice = choice_;
  choice.file = file_;
  choice.limits.while_waiting = stop_if_interrupted;
  return std::make_shared<study::UnitCoupling>(choice, the_case, oil_follows);
}

}  // namespace bentaxis::cli

// bentaxis fmu: a case as a unit for system simulators.
#include <filesystem>
#include <iostream>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/fmu/unit.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct FmuOptions {
  CaseOption the_case;
  std::string out, version = "2", drive, outputs;
  std::vector<fmu::Platform> platforms;
  fmu::UnitOptions unit;
};

// What [drive] of the case makes of its shaft; where it is a torque or a motor, it stays with it.
fmu::Drive usual_drive(const Case& the_case) {
  const bool own = the_case.drive && the_case.drive->kind != DriveKind::speed;
  return own ? fmu::Drive::as_in_case : fmu::Drive::speed;
}

fmu::Drive drive_of(const std::string& word, const Case& the_case) {
  if (word.empty()) return usual_drive(the_case);
  if (word == "case" && !the_case.drive)
    throw InputError("--drive case: " + the_case.file.string() + " has no table [drive]");
  if (word == "case") return fmu::Drive::as_in_case;
  return word == "torque" ? fmu::Drive::torque : fmu::Drive::speed;
}

std::string sentence_of(fmu::Drive drive) {
  switch (drive) {
    case fmu::Drive::speed:
      return "inputs drive_speed and drive_acceleration (--drive speed)";
    case fmu::Drive::torque:
      return "input drive_torque (--drive torque)";
    case fmu::Drive::as_in_case:
      break;
  }
  return "[drive] of the case, no input (--drive case)";
}

fs::path checked_place(const std::string& out) {
  fs::path place = out;
  if (place.extension() != ".fmu" || place.stem().empty())
    throw InputError("--out " + out + ": must be a file that ends in .fmu");
  if (fs::is_directory(place)) throw InputError("--out " + out + ": is a directory");
  return place;
}

void print(const fs::path& file, const FmuOptions& options, const fmu::UnitSummary& has) {
  std::cout << file.string() << ": FMI " << options.version
            << ".0, model exchange and co-simulation, " << has.needs << "\n"
            << "drive: " << sentence_of(options.unit.drive) << "\ninputs:";
  for (const std::string& input : has.inputs) std::cout << " " << input;
  if (has.inputs.empty()) std::cout << " none";
  if (has.start_torque) {
    std::cout << "\ndrive_torque starts at " << *has.start_torque << " Nm";
    if (!has.no_start_torque.empty())
      std::cout << ": the mean torque of the operating point cannot be computed: "
                << has.no_start_torque;
  }
  std::cout << "\noutputs: " << has.outputs << ", states: " << has.states
            << ", event indicators: " << has.indicators << ", parameters: " << has.parameters
            << "\nhow to try it: " << document("fmu.md") << "\n";
}

int make_unit(FmuOptions& options) {
  const fs::path place = checked_place(options.out);
  const Case the_case = options.the_case.read();
  options.unit.version = options.version == "3" ? fmu::Version::fmi3 : fmu::Version::fmi2;
  options.unit.platforms = options.platforms.empty()
                               ? fmu::installed_platforms(options.unit.version)
                               : options.platforms;
  options.unit.drive = drive_of(options.drive, the_case);
  options.unit.si_outputs = options.outputs == "si";
  OutputFolder folder(place.has_parent_path() ? place.parent_path() : fs::path("."));
  folder.add(place.filename().string(), fmu::unit_archive(the_case, options.unit));
  folder.commit();
  print(place, options, fmu::unit_summary(the_case, options.unit));
  return kDone;
}

}  // namespace

Command add_fmu_command(CommandParser program) {
  auto options = std::make_shared<FmuOptions>();
  auto command = program.subcommand(
      "fmu", "Write the pump of a case as a Functional Mock-up Unit for system simulators");
  add_case(command, options->the_case);
  command.option("--out", options->out, Values("FILE.fmu").required(),
                 "where results are written; the FMU, whose directory is made where missing");
  command.option("--fmi", options->version, Values::words({"2", "3"}, "2|3 [2]"),
                 "version of the standard");
  command.option(
      "--drive", options->drive,
      Values::words({"speed", "torque", "case"},
                    "speed|torque|case [speed; case where its [drive] is a torque or a motor]"),
      "what turns the shaft: inputs for its speed and acceleration, an input for its torque, or "
      "[drive] of the case");
  command.option("--output-units", options->outputs,
                 Values::words({"columns", "si"}, "columns|si [columns]"),
                 "units of the outputs: those of the columns of simulate (deg, rpm, mm, bar, "
                 "l/min), or of the "
                 "SI (rad, rad/s, m, Pa, m3/s); names end in them");
  command
      .choices("--platforms", options->platforms, fmu::platform_names(),
               "whose libraries are in the FMU")
      .text("x86_64-linux,x86_64-windows,aarch64-linux [all that are installed]");
  command.flag("--sources", options->unit.sources,
               "also pack the C++ sources of the library, for other platforms (--fmi 3)");
  command.option("--accuracy", options->unit.tolerance, Values::numbers(1e-13, 1e-3),
                 "relative accuracy per step of the time integrator; of co-simulation, relative to "
                 "the scale of each state");
  return {command, [options] { return make_unit(*options); }};
}

}  // namespace bentaxis::cli

// What does a step of co-simulation cost? A unit through its C interface, and the same motion by
// the library in one go, in one run of this program. Prints a Markdown table (docs/fmu.md).
//
//   fmu_steps [CASE] [steps] [seconds simulated]
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/fmu/slave.h"
#include "bentaxis/fmu/unit.h"
#include "bentaxis/hydraulics/oil_in_time.h"

namespace {

using namespace bentaxis;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Seconds of the library: all rows, all channels.
double in_one_go(const Case& the_case, double tolerance) {
  const hydraulics::SteadyState steady = hydraulics::steady_state(the_case);
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  const auto oil = hydraulics::oil_in_time(the_case, hydraulics::running(steady));
  coupled::Options options;
  options.tolerance = tolerance;
  return coupled::simulate("analytic", *mechanics, *oil, *the_case.drive, options).record.seconds;
}

// Seconds of the unit's steps; after each the drive torque is read, for which all outputs are
// computed.
double by_steps(const Case& the_case, fmu::UnitOptions options) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fmu_steps_" + std::to_string(getpid()) + ".fmu");
  std::ofstream(file, std::ios::binary) << fmu::unit_archive(the_case, options);
  const fmu::ImportedUnit unit(file);
  std::filesystem::remove(file);
  const auto pump = unit.instantiate("pump");
  const DriveSpec& drive = *the_case.drive;
  pump->enter_initialisation(0, drive.duration);
  pump->exit_initialisation();
  const fmu::UnitVariable& torque = *unit.description().find("Td_z1_Nm");
  const double step = drive.duration / drive.samples;
  double sum = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < drive.samples; ++i) {
    pump->step(i * step, step);
    sum += pump->get(torque);
  }
  const double seconds = seconds_since(start);
  std::printf("mean drive torque %.3f Nm\n\n", sum / drive.samples);
  return seconds;
}

int measure(const char* file, int steps, double duration) {
  Case the_case = read_case(file);
  the_case.drive = DriveSpec();
  the_case.drive->duration = duration;
  the_case.drive->samples = steps;
  fmu::UnitOptions options;
  const double unit = by_steps(the_case, options);
  const double library = in_one_go(the_case, options.tolerance);
  std::printf("| %d steps over %g s, to %g per step | elapsed | per step |\n|---|---|---|\n", steps,
              duration, options.tolerance);
  std::printf("| unit, through FMI 2 | %.2f s | %.1f us |\n", unit, unit / steps * 1e6);
  std::printf("| library, `simulate` | %.2f s | %.1f us |\n\n", library, library / steps * 1e6);
  std::printf("the unit takes %.2f times as long\n", unit / library);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    constexpr int kSteps = 10000;
    constexpr double kTenTurns = 0.4;  // s, at 1500 rpm
    return measure(
        count > 1 ? arguments[1] : BENTAXIS_SOURCE_DIR "/cases/bap63_rated_hydraulic.toml",
        count > 2 ? std::atoi(arguments[2]) : kSteps,
        count > 3 ? std::atof(arguments[3]) : kTenTurns);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fmu_steps: %s\n", e.what());
    return 1;
  }
}

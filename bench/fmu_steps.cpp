// What does a step of co-simulation cost? A unit through its C interface, and the same motion by
// the library in one go, in one run of this program. And what does it cost that FMUs run in
// processes of their own? Prints Markdown tables (docs/fmu.md, docs/fmu_coupling.md).
//
//   fmu_steps [CASE] [steps] [seconds simulated]
#include <dlfcn.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/fmu/slave.h"
#include "bentaxis/fmu/unit.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "process/calls.h"

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

fmu::ImportedUnit unit_of(const Case& the_case, const fmu::UnitOptions& options) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fmu_steps_" + std::to_string(getpid()) + ".fmu");
  std::ofstream(file, std::ios::binary) << fmu::unit_archive(the_case, options);
  struct Remove {
    const std::filesystem::path& file;
    ~Remove() { std::filesystem::remove(file); }
  } const remove{file};
  return fmu::ImportedUnit(file);
}

// The same functions of an FMU, called within this program as simulators do.
class Within {
 public:
  Within(const fmu::ImportedUnit& unit, double duration) {
    void* library = nullptr;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(unit.folder() / "binaries"))
      if (entry.is_regular_file()) library = dlopen(entry.path().c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error("the library cannot be loaded");
    std::string missing;
    calls_ = fmu::process::fmi2_calls(library, log_, missing);
    const std::string resources = "file://" + (unit.folder() / "resources").string();
    if (!calls_ ||
        !calls_->instantiate("pump", unit.description().token.c_str(), resources.c_str()))
      throw std::runtime_error("the unit does not start");
    calls_->set_up(0, duration);
    calls_->enter_initialisation(0, duration);
    calls_->exit_initialisation();
  }
  ~Within() { calls_->free_instance(); }
  Within(const Within&) = delete;
  Within& operator=(const Within&) = delete;

  void step(double time, double step) {
    std::uint32_t flags = 0;
    if (calls_->step(time, step, flags) != 0) throw std::runtime_error("a step failed");
  }
  double get(const fmu::UnitVariable& variable) {
    double value = 0;
    calls_->get(fmu::process::Type::float64, variable.reference, value);
    return value;
  }

 private:
  fmu::process::Shared shared_{};
  fmu::process::Log log_{shared_};
  std::unique_ptr<fmu::process::Calls> calls_;
};

// Seconds of an instance's steps; after each the drive torque is read, for which all outputs are
// computed.
template <class Instance>
double by_steps(Instance& pump, const fmu::UnitVariable& torque, const DriveSpec& drive) {
  const double step = drive.duration / drive.samples;
  double sum = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < drive.samples; ++i) {
    pump.step(i * step, step);
    sum += pump.get(torque);
  }
  const double seconds = seconds_since(start);
  std::printf("mean drive torque %.3f Nm\n", sum / drive.samples);
  return seconds;
}

// A value that was read before, so that the FMU computes nothing.
void measure_exchange(fmu::Slave& apart, Within& within, const fmu::UnitVariable& torque) {
  constexpr int kExchanges = 20000;
  const auto per_call = [&](const auto& call) {
    call();
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kExchanges; ++i) call();
    return seconds_since(start) / kExchanges * 1e6;
  };
  const std::vector<const fmu::UnitVariable*> twenty(20, &torque);
  const double one_apart = per_call([&] { apart.get(torque); });
  const double twenty_apart = per_call([&] { apart.get(twenty); });
  const double one_within = per_call([&] { within.get(torque); });
  const double twenty_within = per_call([&] {
    for (const fmu::UnitVariable* variable : twenty) within.get(*variable);
  });
  std::printf("\n| | in a process of its own | in the program |\n|---|---|---|\n");
  std::printf("| 1 value read | %.1f us | %.2f us |\n", one_apart, one_within);
  std::printf("| 20 values read at once | %.1f us | %.2f us |\n", twenty_apart, twenty_within);
}

int measure(const char* file, int steps, double duration) {
  Case the_case = read_case(file);
  the_case.drive = DriveSpec();
  the_case.drive->duration = duration;
  the_case.drive->samples = steps;
  fmu::UnitOptions options;
  const fmu::ImportedUnit unit = unit_of(the_case, options);
  const fmu::UnitVariable& torque = *unit.description().find("Td_z1_Nm");
  Within within(unit, duration);
  const double through_fmi = by_steps(within, torque, *the_case.drive);
  unit.instantiate("first")->end();
  const auto start = std::chrono::steady_clock::now();
  const auto apart = unit.instantiate("pump");
  const double start_up = seconds_since(start);
  apart->enter_initialisation(0, duration);
  apart->exit_initialisation();
  const double in_process = by_steps(*apart, torque, *the_case.drive);
  const double library = in_one_go(the_case, options.tolerance);
  std::printf("\n| %d steps over %g s, to %g per step | elapsed | per step |\n|---|---|---|\n",
              steps, duration, options.tolerance);
  const auto row = [&](const char* what, double seconds) {
    std::printf("| %s | %.2f s | %.1f us |\n", what, seconds, seconds / steps * 1e6);
  };
  row("unit, through FMI 2", through_fmi);
  row("unit, in a process of its own", in_process);
  row("library, `simulate`", library);
  std::printf("\nthe unit takes %.2f times as long\n", through_fmi / library);
  measure_exchange(*apart, within, torque);
  std::printf("| process, library and instance are made | %.1f ms | |\n", start_up * 1e3);
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

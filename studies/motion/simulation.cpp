#include "bentaxis/study/simulation.h"

#include <fmt/format.h>

#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/pump/error.h"
#include "simulation_study.h"

namespace bentaxis::study {
namespace {

// What changes in time leaves no motion that repeats itself.
void refuse_trajectory(const Case& the_case) {
  const auto refuse = [&](const char* key, const std::filesystem::path& file) {
    throw InputError(fmt::format(
        "{}{} = \"{}\": must be left out for a periodic motion (--steady): it changes in time",
        the_case.file.empty() ? "" : the_case.file.string() + ": ", key, file.generic_string()));
  };
  const DriveSpec& drive = *the_case.drive;
  if (drive.kind != DriveKind::motor && !drive.curve.time.empty())
    refuse("[drive] file", drive.curve.file);
  if (the_case.hydraulics && the_case.hydraulics->load &&
      !the_case.hydraulics->load->share.time.empty())
    refuse("[load] file", the_case.hydraulics->load->share.file);
}

}  // namespace

const std::vector<std::string>& coordinates_names() {
  static const std::vector<std::string> names = {"constraints", "independent"};
  return names;
}

Coordinates coordinates_of(const SimulationChoice& choice, const Case& the_case) {
  if (choice.coordinates) return *choice.coordinates;
  const bool of_simbody = choice.accuracy || choice.integrator != SimulationChoice{}.integrator;
  return of_simbody || friction_jumps(the_case) ? Coordinates::constraints
                                                : Coordinates::independent;
}

PreparedCase prepare_simulation(Case the_case, const SimulationChoice& choice,
                                const PartProgress& progress_of) {
  if (choice.unit) the_case = choice.unit->driven();
  drive_of(the_case);
  const bool hydraulic = the_case.pressure.kind == PressureKind::hydraulic;
  if (!hydraulic && choice.oil == OilInTime::periodic)
    throw InputError("--oil periodic has no effect: the pressure of the case is not \"hydraulic\"");
  if (choice.steady) {
    if (choice.unit)
      throw InputError(
          "--steady: not possible with --fmu, because an FMU need not be periodic; simulate from "
          "the start");
    refuse_trajectory(the_case);
    if (the_case.pump.gear.contact == ToothContact::teeth)
      throw InputError(
          "--steady: with [gear] contact = \"teeth\" the period is at least one turn, but --steady "
          "searches for a period of an N-th of a turn: simulate from the start");
    const Transfer& transfer = the_case.pump.transfer;
    if (transfer.is_uneven_joint() || transfer.has_own_clearances())
      throw InputError("--steady: with [transfer] " +
                       (transfer.has_own_clearances()
                            ? std::string("clearance_deviation_file")
                            : "kind = \"" + to_string(transfer.kind) + "\"") +
                       " the motion does not repeat after an N-th of a turn, a period for which "
                       "--steady searches: simulate from the start");
    // From rest the search would have no period to begin with: it begins at the speed of
    // [operation].
    if (the_case.drive->start_speed == 0.0) the_case.drive->start_speed.reset();
  }
  if (!hydraulic || choice.oil == OilInTime::periodic)
    return prepare(std::move(the_case), progress_of);
  if (hydraulics::needs_periodic_state(the_case))
    return prepare_start(std::move(the_case), progress_of);
  PreparedCase ready;
  ready.the_case = std::move(the_case);
  return ready;
}

SimulationResult simulate(PreparedCase ready, const SimulationChoice& choice,
                          const PartProgress& progress_of) {
  require_memory(ready.the_case, drive_of(ready.the_case), choice.only ? 1 : 2);
  SimulationResult result;
  result.ready = std::move(ready);
  result.choice = choice;
  result.oil_follows = result.ready.the_case.pressure.kind == PressureKind::hydraulic &&
                       choice.oil == OilInTime::follows;
  run_simulation(result, progress_of);
  result.answers =
      motion_answers(result.analytic ? *result.analytic : *result.multibody, result.ready.the_case);
  return result;
}

}  // namespace bentaxis::study

#include "bentaxis/results/trajectory.h"
#include "bentaxis/study/simulation_document.h"
#include "command_tools.h"
#include "simulation_files.h"
#include "unit_option.h"

namespace bentaxis::cli {
namespace {

struct SimulateOptions {
  CaseOption the_case;
  ReportPlace place;
  std::string model;  ///< "": both
  study::Coordinates coordinates = study::Coordinates::independent;
  std::string oil;  ///< "": it follows the motion
  study::SimulationChoice choice;
  UnitOption unit;
};

int simulate(const SimulateOptions& options, const CommandParser& command) {
  study::SimulationChoice choice = options.choice;
  if (options.model == "analytic") choice.only = study::Model::analytic;
  if (options.model == "multibody") choice.only = study::Model::multibody;
  for (const char* option : {"--integrator", "--accuracy", "--coordinates"})
    if (command.given(option) && choice.only == study::Model::analytic)
      throw InputError(std::string(option) +
                       ": has no effect: only the multibody model has this option");
  if (command.given("--coordinates"))
    choice.coordinates = options.coordinates;
  else if (command.given("--integrator"))  // also the one that is the default
    choice.coordinates = study::Coordinates::constraints;
  if (options.oil == "periodic") choice.oil = study::OilInTime::periodic;
  Case read = options.the_case.read();
  drive_of(read);
  const bool one_method =
      (read.pressure.kind == PressureKind::hydraulic && choice.oil == study::OilInTime::follows) ||
      read.pump.gear.contact == ToothContact::teeth || options.unit.given();
  for (const char* option : {"--integrator", "--accuracy", "--coordinates"})
    if (command.given(option) && (one_method || choice.steady))
      throw InputError(std::string(option) +
                       ": has no effect: with oil, an FMU, resolved tooth contact or a periodic "
                       "motion, one method integrates both models; --error sets its tolerance");
  if (command.given("--integrator") && choice.coordinates == study::Coordinates::independent)
    throw InputError(
        "--integrator: has no effect: independent coordinates are integrated by one method");
  choice.unit = options.unit.coupling(
      command, read,
      read.pressure.kind == PressureKind::hydraulic && choice.oil == study::OilInTime::follows);
  ReportFolders folders(options.place);
  const study::SimulationResult result = study::simulate(
      study::prepare_simulation(std::move(read), choice, progress_of), choice, progress_of);
  folders.publish("report", study::simulation_text(result),
                  study::simulation_document(result, versions(),
                                             study::describe(result.ready.the_case, progress_of,
                                                             study::Described::inputs)),
                  simulation_files(result), study::simulation_curves(result));
  return result.agrees() ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_simulate_command(CommandParser program) {
  auto options = std::make_shared<SimulateOptions>();
  auto command = program.subcommand(
      "simulate",
      "Integrate the motion of shaft and block in time by both models and compare them");
  add_case(command, options->the_case);
  add_report(command, options->place, "report.html, report.json and the curves");
  command.option("--model", options->model,
                 Values::words({"analytic", "multibody"}, "analytic|multibody [both]"),
                 "model that computes; one alone, nothing is compared then");
  command.option(
      "--oil", options->oil, Values::words({"coupled", "periodic"}, "coupled|periodic [coupled]"),
      "of a hydraulic case: \"coupled\", oil that follows the motion, or \"periodic\", the "
      "pressure of the constant speed of [operation], one curve for both models");
  command.flag("--steady", options->choice.steady,
               "find the periodic motion (period: an N-th of a turn) and its stability, instead of "
               "the motion from the start; rows over one turn");
  options->unit.add_to(command);
  command.option("--accuracy", options->choice.accuracy,
                 Values::accuracies("NUMBER [found for --error]"),
                 "relative accuracy per step of the time integrator; selects --coordinates "
                 "constraints unless --coordinates is given");
  command.option(
      "--error", options->choice.error, Values::numbers(1e-10, 0.1),
      "wanted error of every reaction, relative to its peak; both models are integrated to it and "
      "compared by it");
  command.choice("--integrator", options->choice.integrator, multibody::integrator_names(),
                 "time integrator of Simbody; selects --coordinates constraints");
  command
      .choice(
          "--coordinates", options->coordinates, study::coordinates_names(),
          "coordinates in which the multibody model is integrated under a given pressure. With "
          "\"independent\" they are those of shaft, block and rotor, and the pistons follow from "
          "them. With \"constraints\" they are those of every body, which constraint equations "
          "hold together; that is slower")
      .text("constraints|independent [independent]");
  return {command, [options, command] { return simulate(*options, command); }};
}

}  // namespace bentaxis::cli

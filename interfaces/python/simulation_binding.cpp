#include <pybind11/complex.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bentaxis/results/trajectory.h"
#include "bentaxis/study/simulation.h"
#include "bentaxis/study/simulation_document.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "python_case.h"
#include "report.h"
#include "simulation_files.h"
#include "table.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
using study::GroupDifference;
using study::PeriodicMotion;

struct Simulation {
  std::shared_ptr<const study::SimulationResult> result;
  std::vector<std::string> warnings;
};

Simulation simulate(const PythonCase& the_case, const std::optional<std::string>& model,
                    double error, const std::string& oil, bool steady) {
  study::SimulationChoice choice;
  if (model) choice.only = model_called(*model);
  require_in("error", error, 1e-10, 0.1);
  choice.error = error;
  if (oil != "coupled" && oil != "periodic")
    throw InputError("oil " + oil + ": must be coupled or periodic");
  if (oil == "periodic") choice.oil = study::OilInTime::periodic;
  choice.steady = steady;
  Case copy = the_case.copy();
  Simulation simulation;
  simulation.warnings = warned_of(copy);
  std::vector<report::Warning> of_run;
  simulation.result = unlocked([&](const study::PartProgress& progress_of) {
    drive_of(copy);
    auto result = std::make_shared<const study::SimulationResult>(study::simulate(
        study::prepare_simulation(std::move(copy), choice, progress_of), choice, progress_of));
    of_run = study::simulation_document(
                 *result, versions(),
                 study::describe(result->ready.the_case, progress_of, study::Described::inputs))
                 .warnings.value_or(std::vector<report::Warning>());
    return result;
  });
  warn_of(of_run, simulation.warnings);
  return simulation;
}

using Run = std::optional<Trajectory> study::SimulationResult::*;

std::optional<Table> motion(const Simulation& self, Run run) {
  const std::optional<Trajectory>& of = (*self.result).*run;
  if (!of) return std::nullopt;
  return table_of(part_of(self.result, of->table));
}

std::optional<Table> oil(const Simulation& self, Run run, const char* name) {
  const std::optional<Trajectory>& of = (*self.result).*run;
  if (!of || !of->oil) return std::nullopt;
  return oil_table_of(part_of(self.result, *of), name);
}

std::optional<Table> teeth(const Simulation& self, Run run) {
  const std::optional<Trajectory>& of = (*self.result).*run;
  if (!of || of->teeth.empty()) return std::nullopt;
  return table_of(std::make_shared<const MotionTable>(
      teeth_table_of(*of, self.result->ready.the_case.pump.gear)));
}

std::vector<std::filesystem::path> report_simulation(const Simulation& self,
                                                     const std::filesystem::path& folder) {
  return unlocked([&](const study::PartProgress& progress_of) {
    const study::SimulationResult& result = *self.result;
    return write_report(
        folder, "bentaxis.simulate", {&result.ready.the_case},
        study::simulation_document(
            result, versions(),
            study::describe(result.ready.the_case, progress_of, study::Described::inputs)),
        study::simulation_curves(result), cli::simulation_files(result));
  });
}

void add_simulation_pieces(py::module_& module) {
  py::class_<GroupDifference>(
      module, "GroupDifference",
      "Difference of the models in a group of channels, relative to its peak.")
      .def_readonly("group", &GroupDifference::group, "Group of channels.")
      .def_readonly("unit", &GroupDifference::unit, "Of the peak.")
      .def_readonly("peak", &GroupDifference::peak, "Largest magnitude.")
      .def_readonly("in_time", &GroupDifference::in_time, "Largest difference at equal times.")
      .def_readonly("time_s", &GroupDifference::time_s, "When that is.")
      .def_readonly("over_angle", &GroupDifference::over_angle,
                    "Largest difference at equal angles of the shaft.")
      .def_readonly("of_allowed", &GroupDifference::of_allowed,
                    "Largest difference over the tolerance at that time: 1 is the limit.");
  py::class_<PeriodicMotion>(module, "PeriodicMotion", "A periodic motion.")
      .def_readonly("period_s", &PeriodicMotion::period_s, "Its period.")
      .def_readonly("speed_rad_per_s", &PeriodicMotion::speed, "Mean speed of the shaft.")
      .def_readonly("iterations", &PeriodicMotion::iterations, "Of the search.")
      .def_readonly("error", &PeriodicMotion::error,
                    "Largest error of a state, relative to its scale.")
      .def_readonly("multipliers", &PeriodicMotion::multipliers,
                    "Floquet multipliers, largest magnitude first.")
      .def_property_readonly("stable", &PeriodicMotion::stable, "Whether disturbances decay.");
}

}  // namespace

void add_simulation(py::module_& module) {
  add_simulation_pieces(module);
  constexpr Run kAnalytic = &study::SimulationResult::analytic;
  constexpr Run kMultibody = &study::SimulationResult::multibody;
  const auto result = [](auto member) { return of(&Simulation::result, member); };
  const auto periodic = [](int model) {
    return [model](const Simulation& self) { return self.result->periodic[model]; };
  };
  py::class_<Simulation>(module, "Simulation",
                         "Motion in time by both models, or by one, and their differences.")
      .def_property_readonly(
          "agrees", result(&study::SimulationResult::agrees),
          "Whether both models agree; of one model: whether its checks are passed.")
      .def_property_readonly("headline", result(&study::SimulationResult::headline),
                             "The verdict in a sentence.")
      .def_property_readonly("text", result(study::simulation_text),
                             "Text that the program prints.")
      .def_property_readonly(
          "analytic", [](const Simulation& self) { return motion(self, kAnalytic); },
          "Results of the analytic model over time; None where it was not run.")
      .def_property_readonly(
          "multibody", [](const Simulation& self) { return motion(self, kMultibody); },
          "Results of the multibody model; None where it was not run.")
      .def_property_readonly(
          "oil_analytic",
          [](const Simulation& self) { return oil(self, kAnalytic, "oil, analytic"); },
          "Results of the oil; None where it does not follow the motion.")
      .def_property_readonly(
          "oil_multibody",
          [](const Simulation& self) { return oil(self, kMultibody, "oil, multibody"); },
          "Likewise.")
      .def_property_readonly(
          "teeth_analytic", [](const Simulation& self) { return teeth(self, kAnalytic); },
          "Results of the teeth; None without resolved tooth contact.")
      .def_property_readonly(
          "teeth_multibody", [](const Simulation& self) { return teeth(self, kMultibody); },
          "Likewise.")
      .def_property_readonly("periodic_analytic", periodic(0),
                             "Periodic motion; None where it was not requested.")
      .def_property_readonly("periodic_multibody", periodic(1), "Likewise.")
      .def_property_readonly("groups", result(&study::SimulationResult::groups),
                             "Differences of the models.")
      .def_property_readonly("checks", result(&study::SimulationResult::checks),
                             "Checks: quantities that must be zero.")
      .def_readonly("warnings", &Simulation::warnings, "Warnings about the case and the motion.")
      .def_property_readonly(
          "judged_until_s", result(&study::SimulationResult::judged_until_s),
          "Time up to which results are compared; after it a disturbance of the wanted error is "
          "amplified too much.")
      .def("report", &report_simulation, py::arg("folder"),
           "Writes report.html, report.json and the curves as the program does; returns their "
           "paths.")
      .def(
          "__repr__",
          [](const Simulation& self) {
            return "<bentaxis.Simulation: " + self.result->headline() + ">";
          },
          "The headline.");
  module.def("simulate", &simulate, py::arg("case"), py::arg("model") = py::none(), py::kw_only(),
             py::arg("error") = 1e-6, py::arg("oil") = "coupled", py::arg("steady") = false,
             "Integrates the motion of shaft and block in time, with the drive in [drive] of the "
             "case, by both models or by one. `error`: wanted error of every reaction, relative to "
             "its peak, in [1e-10, 0.1]. `oil`, of a hydraulic case: \"coupled\" or \"periodic\". "
             "`steady`: the periodic motion and its stability.");
}

}  // namespace bentaxis::python

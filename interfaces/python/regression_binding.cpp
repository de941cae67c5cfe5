#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "bentaxis/designs/explain.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/report/junit.h"
#include "bentaxis/study/comparison_answers.h"
#include "bentaxis/study/regression.h"
#include "bentaxis/study/regression_document.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "report.h"
#include "table.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;
using study::GroupLine;
using study::Outcome;

struct Regression {
  std::shared_ptr<const std::vector<Outcome>> outcomes;
};
struct Held {
  std::shared_ptr<const Outcome> outcome;
};

std::string state_of(const Outcome& outcome) {
  constexpr const char* kStates[] = {"agrees", "differs", "unusable", "failed"};  // as in the enum
  return kStates[static_cast<int>(outcome.state)];
}

Regression regress(const std::optional<fs::path>& folder, const std::string& filter) {
  fs::path root;
  if (folder) {
    root = *folder;
  } else {
    const auto with_package = shipped("reference_data");
    if (!with_package)
      throw InputError("no reference data are installed with this package: give a directory");
    root = *with_package;
  }
  return {unlocked([&](const study::PartProgress& progress_of) {
    std::vector<study::ReferencePlace> places = study::references_below(root);
    std::erase_if(places,
                  [&](const auto& place) { return place.name.find(filter) == std::string::npos; });
    if (places.empty())
      throw InputError("filter \"" + filter + "\" leaves none of the cases below " + root.string());
    std::vector<Outcome> outcomes;
    for (const auto& place : places) {
      outcomes.push_back(study::hold(place, progress_of));
      designs::explain(outcomes.back(), place, progress_of);
    }
    return std::make_shared<const std::vector<Outcome>>(std::move(outcomes));
  })};
}

void write_junit(const Regression& self, const fs::path& path) {
  unlocked([&](const study::PartProgress&) {
    std::vector<report::TestSuite> suites;
    for (const Outcome& outcome : *self.outcomes) suites.push_back(study::suite_of(outcome));
    write_file(path, report::junit_xml("bentaxis regress", suites));
  });
}

std::optional<Table> table(const Held& self, const std::string& model, bool reference) {
  const auto held = self.outcome->held.find(model);
  if (held == self.outcome->held.end()) return std::nullopt;
  return table_of(part_of(self.outcome, reference ? held->second.reference : held->second.result));
}

void add_regression_pieces(py::module_& module) {
  const auto outcome = [](auto member) { return of(&Held::outcome, member); };
  py::class_<GroupLine>(module, "ReferenceGroup",
                        "Comparison of a group of channels of one model with one reference.")
      .def_readonly("reference", &GroupLine::reference, "Name of the reference.")
      .def_readonly("kind", &GroupLine::kind, "Kind of the reference.")
      .def_readonly("model", &GroupLine::model, "Name of the model.")
      .def_readonly("group", &GroupLine::group, "Group of channels.")
      .def_readonly("compared", &GroupLine::compared, "Number of channels that were compared.")
      .def_readonly("missing", &GroupLine::missing,
                    "Number of channels that the reference does not have.")
      .def_readonly("failed", &GroupLine::failed, "Number of channels that differ.")
      .def_property_readonly("verdict", &GroupLine::verdict, "In a word.")
      .def_property_readonly("text", &GroupLine::text,
                             "Channel and angle of the largest difference, and its likely kind.")
      .def(
          "__repr__",
          [](const GroupLine& self) {
            return "<bentaxis.ReferenceGroup " + self.reference + ", " + self.model + ", " +
                   self.group + ": " + self.verdict() + ">";
          },
          "Group and verdict.");
  py::class_<Held>(module, "Outcome", "Result for one reference.")
      .def_property_readonly("name", outcome(&Outcome::name), "Name of the reference.")
      .def_property_readonly("kind", outcome(&Outcome::kind), "Kind of the reference.")
      .def_property_readonly("state", outcome(state_of),
                             "\"agrees\", \"differs\", \"unusable\" or \"failed\".")
      .def_property_readonly("error", outcome(&Outcome::error),
                             "Why it differs as a whole, is unusable or failed.")
      .def_property_readonly("groups", outcome(&Outcome::lines),
                             "Result for each group of channels of each model.")
      .def_property_readonly(
          "explanation",
          [](const Held& self) {
            return self.outcome->explanation ? self.outcome->explanation->text() : std::string();
          },
          "Where it differs: which parameters of the case would explain it, in words.")
      .def_property_readonly("notes", outcome(&Outcome::notes), "Further remarks.")
      .def(
          "result",
          [](const Held& self, const std::string& model) { return table(self, model, false); },
          py::arg("model"), "Results of a model; None where it was not run.")
      .def(
          "reference",
          [](const Held& self, const std::string& model) { return table(self, model, true); },
          py::arg("model"), "The reference at the same angles.")
      .def(
          "__repr__",
          [](const Held& self) {
            return "<bentaxis.Outcome " + self.outcome->name + ": " + state_of(*self.outcome) + ">";
          },
          "Name and state.");
}

}  // namespace

void add_regression(py::module_& module) {
  add_regression_pieces(module);
  py::class_<Regression>(module, "Regression", "Comparison of both models with stored curves.")
      .def_property_readonly(
          "agrees",
          [](const Regression& self) {
            return std::all_of(
                self.outcomes->begin(), self.outcomes->end(),
                [](const Outcome& one) { return one.state == Outcome::State::agrees; });
          },
          "Whether all references agree.")
      .def_property_readonly(
          "summary", [](const Regression& self) { return study::summary(*self.outcomes); },
          "Summary in one sentence.")
      .def_property_readonly(
          "text", [](const Regression& self) { return study::regression_report(*self.outcomes); },
          "Text that the program prints.")
      .def_property_readonly(
          "outcomes",
          [](const Regression& self) {
            std::vector<Held> all;
            for (const Outcome& one : *self.outcomes) all.push_back({part_of(self.outcomes, one)});
            return all;
          },
          "Result for each reference.")
      .def("write_junit", &write_junit, py::arg("path"), "Writes a JUnit file for CI.")
      .def(
          "__repr__",
          [](const Regression& self) {
            return "<bentaxis.Regression: " + study::summary(*self.outcomes) + ">";
          },
          "The summary.");
  module.def("regress", &regress, py::arg("folder") = py::none(), py::arg("filter") = "",
             "Compares both models with the references in a directory, or with those that come "
             "with bentaxis. `filter`: only references whose name contains this text.");
}

}  // namespace bentaxis::python

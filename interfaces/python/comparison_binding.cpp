#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>

#include "bentaxis/pump/lists.h"
#include "bentaxis/study/assumptions.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "python_case.h"
#include "report.h"
#include "result_files.h"
#include "table.h"
#include "values.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
using compare::ChannelComparison;
using Result = std::shared_ptr<const study::ComparisonResult>;

struct Comparison {
  Result result;
  std::vector<std::string> warnings;
};

// Of both cases where there are two, each text once.
std::vector<std::string> implausible(const Case& first, const std::optional<Case>& second) {
  std::vector<std::string> texts = plausibility_texts(first);
  if (!second) return texts;
  for (const std::string& text : plausibility_texts(*second)) add_once(texts, text);
  return texts;
}

void assume(const CaseValues& settings, const char* what, const PumpParameters& pump,
            Assumptions& assumptions) {
  for (const auto& [key, value] : items_of(settings, what)) {
    const std::string text = py::isinstance<py::bool_>(value) ? (value.cast<bool>() ? "on" : "off")
                                                              : std::string(py::str(value));
    study::apply_assumption(key + "=" + text, pump, assumptions);
  }
}

Comparison compare_cases(const PythonCase& the_case, const CaseValues& multibody,
                         const CaseValues& analytic, const PythonCase* multibody_case,
                         const Texts& channels, std::optional<double> tolerance) {
  if (tolerance && !(*tolerance > 0)) throw InputError("tolerance: must be a positive number");
  Case first = the_case.copy();
  std::optional<Case> second;
  if (multibody_case != nullptr) second = multibody_case->copy();
  assume(analytic, "analytic", first.pump, first.analytic);
  Case& of_multibody = second ? *second : first;
  assume(multibody, "multibody", of_multibody.pump, of_multibody.multibody);
  study::ComparisonOptions options;
  options.channels = study::ChannelChoice(texts_of(channels, "channels"));
  options.scene.scene = options.channels.scene_for(ChannelLayout(first.pump), std::nullopt);
  options.tolerance = tolerance;
  options.loads = true;
  if (const auto data = shipped("reference_data")) options.published = *data / "published";
  Comparison comparison;
  comparison.warnings = implausible(first, second);
  warn_of_plausibility(comparison.warnings);
  comparison.result = unlocked([&](const study::PartProgress& progress_of) {
    if (second) study::check_same_run(first, *second);
    return std::make_shared<const study::ComparisonResult>(
        study::compare_models(std::move(first), std::move(second), options, progress_of));
  });
  warn_of(comparison.result->warnings, comparison.warnings);
  return comparison;
}

std::vector<std::filesystem::path> report_comparison(const Comparison& self,
                                                     const std::filesystem::path& folder) {
  return unlocked([&](const study::PartProgress& progress_of) {
    const study::ComparisonResult& result = *self.result;
    const report::Document document =
        study::comparison_document(result, versions(), study::describe(result, progress_of));
    return write_report(folder, "bentaxis.compare",
                        {&result.first.the_case, &result.second.the_case}, document,
                        study::comparison_curves(result, document, report::Rows::shown),
                        cli::comparison_files(result));
  });
}

// The channel of each group that is furthest apart.
std::map<std::string, ChannelComparison> groups(const Comparison& self) {
  std::map<std::string, ChannelComparison> worst;
  for (const ChannelComparison& one : self.result->comparison.channels) {
    if (!one.judged || !one.compared()) continue;
    const auto [place, added] = worst.emplace(one.channel.group, one);
    if (!added && one.largest_over_peak() > place->second.largest_over_peak()) place->second = one;
  }
  return worst;
}

std::optional<ChannelComparison> worst(const Comparison& self) {
  const ChannelComparison* const found = self.result->comparison.worst();
  if (found == nullptr) return std::nullopt;
  return *found;
}

Table table(const Comparison& self, const ResultTable& part) {
  return table_of(part_of(self.result, part));
}

void add_comparison_pieces(py::module_& module) {
  py::class_<ChannelComparison>(module, "ChannelComparison",
                                "Difference of the two models in one channel: multibody minus "
                                "analytic, in the unit of the channel.")
      .def_property_readonly(
          "name", [](const ChannelComparison& self) { return self.channel.name; },
          "Name of the channel.")
      .def_readonly("channel", &ChannelComparison::channel, "Description of the channel.")
      .def_property_readonly(
          "verdict",
          [](const ChannelComparison& self) { return std::string(to_string(self.verdict)); },
          "In a word.")
      .def_readonly("judged", &ChannelComparison::judged,
                    "Whether the channel counts for the verdict.")
      .def_readonly("peak", &ChannelComparison::peak,
                    "Largest magnitude of the channel's group, at least a thousandth of the "
                    "largest load of the case.")
      .def_readonly("own_peak", &ChannelComparison::own_peak,
                    "Largest magnitude of this channel alone.")
      .def_readonly("largest", &ChannelComparison::largest, "Largest difference.")
      .def_property_readonly("largest_over_peak", &ChannelComparison::largest_over_peak,
                             "Largest difference over the peak.")
      .def_readonly("theta_of_largest_deg", &ChannelComparison::theta_of_largest_deg,
                    "Angle of the shaft at the largest difference.")
      .def_readonly("rms", &ChannelComparison::rms, "Root of the mean square of the difference.")
      .def_readonly("mean_difference", &ChannelComparison::mean_difference,
                    "Mean of the difference.")
      .def_readonly("digits", &ChannelComparison::digits, "Digits of agreement.")
      .def_readonly("tolerance", &ChannelComparison::tolerance, "Allowed difference over the peak.")
      .def(
          "__repr__",
          [](const ChannelComparison& self) {
            return "<bentaxis.ChannelComparison " + self.channel.name + ": " +
                   to_string(self.verdict) + ">";
          },
          "Name and verdict.");
  py::class_<compare::Check>(module, "Check",
                             "A check: a quantity that must be zero in every row of a table.")
      .def_readonly("table", &compare::Check::table, "Model of the table.")
      .def_readonly("name", &compare::Check::name, "Quantity that must be zero.")
      .def_readonly("worst", &compare::Check::worst, "Largest magnitude of the quantity.")
      .def_readonly("unit", &compare::Check::unit, "Unit of that.")
      .def_property_readonly("relative", &compare::Check::relative,
                             "Largest magnitude over its scale.")
      .def_property_readonly("holds", &compare::Check::holds, "Whether it is within tolerance.");
}

}  // namespace

void add_comparison(py::module_& module) {
  const auto result = [](auto member) { return of(&Comparison::result, member); };
  add_comparison_pieces(module);
  py::class_<Comparison>(module, "Comparison",
                         "Results of both models on one case, and their differences.")
      .def_property_readonly(
          "agrees", result(&study::ComparisonResult::passes),
          "Verdict: every difference, less what stated assumptions explain, is within tolerance, "
          "and every check is passed.")
      .def_property_readonly("headline", result(&study::ComparisonResult::headline),
                             "The verdict in a sentence.")
      .def_property_readonly("text", result(study::comparison_text),
                             "Text that the program prints.")
      .def_property_readonly("tolerance", result(&study::ComparisonResult::tolerance),
                             "Allowed difference over the peak.")
      .def_property_readonly(
          "worst", &worst,
          "The channel with the largest difference over its peak; None where none "
          "was compared.")
      .def_property_readonly(
          "channels", [](const Comparison& self) { return self.result->comparison.channels; },
          "Every channel.")
      .def_property_readonly(
          "groups", &groups,
          "For each group of channels with a common peak, the channel with the largest difference.")
      .def_property_readonly(
          "analytic", [](const Comparison& self) { return table(self, self.result->analytic); },
          "Results of the analytic model.")
      .def_property_readonly(
          "multibody", [](const Comparison& self) { return table(self, self.result->multibody); },
          "Results of the multibody model.")
      .def_property_readonly(
          "pressure",
          [](const Comparison& self) -> std::optional<Table> {
            if (!self.result->first.hydraulics) return std::nullopt;
            return table(self, self.result->first.hydraulics->table);
          },
          "Results of the hydraulic model; None where the pressure is given by the case.")
      .def_property_readonly("checks", result(&study::ComparisonResult::checks),
                             "Checks of each model.")
      .def_readonly("warnings", &Comparison::warnings, "Warnings about the case and the results.")
      .def("report", &report_comparison, py::arg("folder"),
           "Writes report.html, report.json and the curves as the program does; returns their "
           "paths.")
      .def(
          "__repr__",
          [](const Comparison& self) {
            return "<bentaxis.Comparison: " + self.result->headline() + ">";
          },
          "The headline.");
  module.def(
      "compare", &compare_cases, py::arg("case"), py::arg("multibody") = py::none(), py::kw_only(),
      py::arg("analytic") = py::none(), py::arg("multibody_case") = nullptr,
      py::arg("channels") = py::none(), py::arg("tolerance") = py::none(),
      "Runs both models over one turn and compares them. `multibody`, `analytic`: assumptions of a "
      "model that override the case, {\"piston_friction\": False, \"gear\": \"imposed\"}: the "
      "difference is then split by assumption. `multibody_case`: another case for the multibody "
      "model. `channels`: only these channels.");
}

}  // namespace bentaxis::python

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include "bentaxis/designs/optimise_document.h"
#include "bentaxis/designs/pareto.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/number.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "designs_table.h"
#include "python_case.h"
#include "report.h"
#include "values.h"
#include "words.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;
using designs::ChosenDesign;

struct Optimisation : Table {
  std::shared_ptr<const designs::Optimisation> found;
  fs::path file;  // of the case
};

Optimisation shown(std::shared_ptr<const designs::Optimisation> found, const fs::path& file) {
  Optimisation shown{designs_table("optimisation", found->plan.designs, found->evaluated(),
                                   found->designs.values.data(), found->measured.data()),
                     found, file};
  shown.csv = [found] { return designs::evaluations_csv(*found); };
  shown.owner = std::move(found);
  return shown;
}

designs::SearchComparisonChoice comparison_called(const std::string& name) {
  if (name == "fast") return designs::SearchComparisonChoice::fast;
  if (name == "yes") return designs::SearchComparisonChoice::yes;
  if (name == "no") return designs::SearchComparisonChoice::no;
  throw InputError("comparison " + name + ": must be fast, yes or no");
}

std::size_t count_in(const char* name, int value, int low, int high) {
  const NumberRange range{static_cast<double>(low), static_cast<double>(high)};
  if (!range.contains(value))
    throw InputError(std::string(name) + " = " + std::to_string(value) + ": must be " +
                     range.text());
  return static_cast<std::size_t>(value);
}

Optimisation optimise(const PythonCase& the_case, const Variations& vary, const Texts& minimise,
                      const Texts& maximise, const Texts& subject_to, const Texts& outputs,
                      const std::optional<fs::path>& conditions, int population, int generations,
                      int restarts, std::uint64_t seed, bool refine, int samples,
                      const std::string& comparison, const std::string& model, int threads) {
  designs::OptimiseRequest request;
  for (const auto& [name, values] : items_of(vary, "vary"))
    request.vary.emplace_back(name, values_text(name, values));
  request.minimise = texts_of(minimise, "minimise");
  request.maximise = texts_of(maximise, "maximise");
  request.subject_to = texts_of(subject_to, "subject_to");
  request.outputs = texts_of(outputs, "outputs");
  if (conditions) request.conditions = *conditions;
  request.search.population = count_in("population", population, 8, designs::kMaxPopulation);
  request.search.generations = count_in("generations", generations, 0, designs::kMaxGenerations);
  request.search.restarts = count_in("restarts", restarts, 1, designs::kMaxRestarts);
  request.search.seed = seed;
  request.search.refine = refine;
  request.samples = count_in("samples", samples, 1, designs::kMaxSamples);
  request.comparison = comparison_called(comparison);
  request.model = model_called(model);
  designs::OptimiseWork work;
  work.threads = static_cast<int>(count_in("threads", threads, 0, 1024));
  const Case copy = the_case.copy();
  const std::vector<std::string> implausible = warned_of(copy);
  Optimisation found =
      shown(unlocked([&](const study::PartProgress& progress_of) {
              const designs::Optimiser optimiser(copy, designs::optimise_plan(request, copy));
              return std::make_shared<const designs::Optimisation>(
                  optimiser.run(work, progress_of("optimise")));
            }),
            the_case.file());
  found.warnings = implausible;
  return found;
}

std::vector<std::size_t> front(const Optimisation& self) {
  return designs::pareto_front(self.found->designs.results, self.found->plan.designs.direction);
}

PythonCase case_of(const Optimisation& self, std::size_t design) {
  if (design >= self.found->evaluated())
    throw py::index_error("design " + std::to_string(design) + ": there are " +
                          std::to_string(self.found->evaluated()));
  return {case_text(designs::case_of(*self.found, design)), self.file, {}};
}

std::vector<fs::path> report_optimisation(const Optimisation& self, const fs::path& folder) {
  const designs::Optimisation& found = *self.found;
  std::vector<cli::TextFile> files = cli::text_files(designs::chosen_cases(found));
  files.emplace_back("front.csv", designs::front_csv(found));
  files.emplace_back("evaluations.csv", designs::evaluations_csv(found));
  return unlocked([&](const study::PartProgress& progress_of) {
    return write_report(folder, "bentaxis.optimise", {&found.designs.base},
                        designs::optimise_document(
                            found, versions(), study::describe(found.designs.base, progress_of)),
                        {}, files);
  });
}

}  // namespace

void add_optimisation(py::module_& module) {
  py::class_<ChosenDesign>(module, "ChosenDesign", "A chosen design of the front.")
      .def_readonly("why", &ChosenDesign::why, "\"lowest peak:Rb1\", \"balanced\".")
      .def_readonly("design", &ChosenDesign::design, "Row of the design.");
  py::class_<Optimisation, Table, std::shared_ptr<Optimisation>>(
      module, "Optimisation",
      "A table of all designs that a search evaluated: parameters that vary and outputs, in the "
      "order of the evaluations.")
      .def_property_readonly(
          "chosen", of(&Optimisation::found, &designs::Optimisation::chosen),
          "The best design of each objective and a balanced one; empty where no design keeps all "
          "constraints.")
      .def_property_readonly("front", &front, "Rows of the Pareto front.")
      .def_property_readonly(
          "infeasible", [](const Optimisation& self) { return reasons_of(self.found->designs); },
          "Reasons why designs are infeasible or have no outputs, by row.")
      .def_property_readonly(
          "headline", [](const Optimisation& self) { return designs::headline(*self.found); },
          "Summary in one line.")
      .def_property_readonly(
          "answers",
          [](const Optimisation& self) {
            std::vector<std::string> answers;
            for (const std::string& answer : designs::optimise_answers(*self.found))
              answers.push_back(in_python(answer));
            return answers;
          },
          "The chosen designs and how sure they are, in sentences.")
      .def_property_readonly(
          "seconds", [](const Optimisation& self) { return self.found->designs.seconds; },
          "What the search took.")
      .def("case", &case_of, py::arg("design"), "The case of a row.")
      .def("report", &report_optimisation, py::arg("folder"),
           "Writes report.html, report.json, front.csv, evaluations.csv and the chosen cases as "
           "the program does; returns their paths.");
  module.def(
      "optimise", &optimise, py::arg("case"), py::arg("vary"), py::arg("minimise") = py::none(),
      py::arg("maximise") = py::none(), py::arg("subject_to") = py::none(), py::kw_only(),
      py::arg("outputs") = py::none(), py::arg("conditions") = py::none(),
      py::arg("population") = 64, py::arg("generations") = 50, py::arg("restarts") = 2,
      py::arg("seed") = 1, py::arg("refine") = true, py::arg("samples") = 100,
      py::arg("comparison") = "fast", py::arg("model") = "analytic", py::arg("threads") = 0,
      "The best designs (docs/optimisation.md). `vary`: a range \"25:42\" or a list of values by "
      "parameter. `minimise`, `maximise`: outputs, also quantiles under [uncertainty] as "
      "\"q95:peak:Rb1\", from `samples` of it. `subject_to`: \"peak:Rs <= 13000\". `conditions`: a "
      "file of operating points. `comparison`: random and grid search beside it, \"fast\", "
      "\"yes\" or \"no\".");
}

}  // namespace bentaxis::python

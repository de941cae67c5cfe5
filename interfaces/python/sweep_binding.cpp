#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bentaxis/designs/sweep_document.h"
#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/pump/number.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "designs_table.h"
#include "python_case.h"
#include "report.h"
#include "values.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
using designs::SweepCheck;

struct Sweep : Table {
  std::shared_ptr<const designs::SweepResult> result;
};

Sweep shown(std::shared_ptr<const designs::SweepResult> result) {
  Sweep sweep{designs_table("sweep", result->plan, result->designs, result->values.data(),
                            result->results.data()),
              result};
  sweep.csv = [result] { return designs::sweep_csv(*result); };
  sweep.owner = std::move(result);
  return sweep;
}

Sweep sweep(const PythonCase& the_case, const Variations& vary, const Texts& outputs,
            const std::string& sampling, std::size_t samples, std::uint64_t seed,
            const std::string& model, double check, const Texts& minimise, const Texts& maximise,
            int threads) {
  designs::SweepRequest request;
  const auto& words = designs::sampling_words();
  const auto word = std::find(words.begin(), words.end(), sampling);
  if (word == words.end())
    throw InputError("sampling " + sampling + ": must be grid, lhs, sobol or random");
  request.sampling = static_cast<designs::Sampling>(word - words.begin());
  for (const auto& [name, values] : items_of(vary, "vary"))
    request.vary.emplace_back(name, values_text(name, values));
  request.samples = samples;
  request.seed = seed;
  request.outputs = texts_of(outputs, "outputs");
  request.minimise = texts_of(minimise, "minimise");
  request.maximise = texts_of(maximise, "maximise");
  request.model = model_called(model);
  if (!(check >= 0 && check <= 1))
    throw InputError("check = " + (std::isnan(check) ? "nan" : number_text(check)) +
                     ": must be a share of the designs, 0 to 1");
  request.check_share = check;
  if (threads < 0) throw InputError("threads = " + std::to_string(threads) + ": must be >= 0");
  const Case copy = the_case.copy();
  const std::vector<std::string> implausible = warned_of(copy);
  Sweep swept = shown(unlocked([&](const study::PartProgress& progress_of) {
    const designs::Sweep all(copy, designs::sweep_plan(request, copy));
    return std::make_shared<const designs::SweepResult>(
        designs::compute_in_memory(all, threads, progress_of("sweep")));
  }));
  swept.warnings = implausible;
  return swept;
}

std::vector<std::filesystem::path> report_sweep(const Sweep& self,
                                                const std::filesystem::path& folder) {
  return unlocked([&](const study::PartProgress& progress_of) {
    return write_report(folder, "bentaxis.sweep", {&self.result->base},
                        designs::sweep_document(*self.result, versions(),
                                                study::describe(self.result->base, progress_of)),
                        {}, {{"sweep.csv", self.csv()}});
  });
}

}  // namespace

void add_sweep(py::module_& module) {
  const auto result = [](auto member) { return of(&Sweep::result, member); };
  py::class_<SweepCheck>(module, "SweepCheck",
                         "A design that was also computed by the other model.")
      .def_readonly("design", &SweepCheck::design, "Row of the design.")
      .def_readonly("own", &SweepCheck::own, "Outputs by the model of the sweep.")
      .def_readonly("values", &SweepCheck::values, "Outputs by the other model.")
      .def_readonly("scales", &SweepCheck::scales,
                    "Scales that differences are relative to; 0: not compared.")
      .def_property_readonly(
          "agrees",
          [](const SweepCheck& self) -> std::optional<bool> {
            if (!self.compared()) return std::nullopt;
            return self.agrees(designs::kCheckTolerance);
          },
          "Whether all outputs agree within 1e-9 of their scales; None where nothing was compared, "
          "as where both models refuse the design.");
  py::class_<Sweep, Table, std::shared_ptr<Sweep>>(
      module, "Sweep",
      "A table of designs: parameters that vary, in the units of the case file, and outputs. A "
      "choice is the index of its word, from 0.")
      .def_property_readonly("infeasible", result(reasons_of),
                             "Reasons why designs have no outputs, by row.")
      .def_property_readonly("checks", result(&designs::SweepResult::checks),
                             "Designs that were also computed by the other model.")
      .def_property_readonly("agrees", result(&designs::SweepResult::agrees),
                             "Whether all designs that both models computed agree, and there are "
                             "any, where designs were to be checked.")
      .def_property_readonly(
          "headline", [](const Sweep& self) { return designs::headline(*self.result); },
          "Summary in one line.")
      .def_property_readonly("seconds", result(&designs::SweepResult::seconds),
                             "Elapsed time of the computation.")
      .def("report", &report_sweep, py::arg("folder"),
           "Writes report.html, report.json and sweep.csv as the program does; returns their "
           "paths.");
  module.def(
      "sweep", &sweep, py::arg("case"), py::arg("vary"), py::arg("outputs"), py::kw_only(),
      py::arg("sampling") = "grid", py::arg("samples") = 0, py::arg("seed") = 1,
      py::arg("model") = "analytic", py::arg("check") = 0.0, py::arg("minimise") = py::none(),
      py::arg("maximise") = py::none(), py::arg("threads") = 0,
      "Outputs of many designs (docs/sweeps.md), on all processors or `threads` of them. `vary`: "
      "values by parameter, a list, an array or a text as \"20:40:5\" or, where they are sampled, "
      "\"normal(40, 0.1)\". `outputs`: \"max:Rb1_z1\", \"mean:Td\". `sampling`: \"grid\", or "
      "\"lhs\", "
      "\"sobol\", \"random\" with a number of `samples`. `check`: share of the designs that the "
      "other "
      "model computes too.");
}

}  // namespace bentaxis::python

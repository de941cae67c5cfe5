#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>

#include "bentaxis/designs/identify_document.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/number.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "python_case.h"
#include "report.h"
#include "table.h"
#include "values.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;
using designs::Minimum;

struct Found {
  designs::DataModel model;
  designs::Identification result;
};
struct Identification {
  std::shared_ptr<const Found> found;
  fs::path file;  // of the case
};

designs::IdentifyOptions options_of(int starts, std::uint64_t seed, int steps, int draws,
                                    double measured, bool fit_only, int threads) {
  require_in("starts", starts, 1, 10000);
  require_in("steps", steps, 20, 1000000);
  require_in("draws", draws, 10, 100000);
  require_in("measured", measured, 1e-6, 1);
  require_in("threads", threads, 0, 1024);
  designs::IdentifyOptions options;
  options.starts = starts;
  options.seed = seed;
  options.steps = steps;
  options.draws = draws;
  options.measured = measured;
  options.threads = threads;
  if (fit_only) options.posterior = options.profiles = options.leave_one_out = false;
  return options;
}

// Lowest and highest values as the option --unknown has them.
std::vector<std::string> bounds_of(const Bounds& unknowns) {
  std::vector<std::string> bounds;
  for (const auto& [name, pair] : items_of(unknowns, "unknowns")) {
    std::pair<double, double> ends;
    try {
      ends = pair.cast<std::pair<double, double>>();
    } catch (const py::cast_error&) {
      throw InputError("unknowns: " + name + ": must be a pair, its lowest and its highest value");
    }
    bounds.push_back(name + "=" + number_text(ends.first) + ":" + number_text(ends.second));
  }
  return bounds;
}

Identification identify(const PythonCase& the_case, const Paths& data, const Bounds& unknowns,
                        int starts, std::uint64_t seed, int steps, int draws, double measured,
                        bool fit_only, int threads) {
  const std::vector<std::string> files = paths_of(data, "data");
  const std::vector<std::string> bounds = bounds_of(unknowns);
  const designs::IdentifyOptions options =
      options_of(starts, seed, steps, draws, measured, fit_only, threads);
  if (designs::least_squares_library().empty())
    throw InputError(
        "identify: this module was built without Ceres; install libceres-dev (scripts/setup full) "
        "and build again");
  Case copy = the_case.copy();
  warned_of(copy);
  return {unlocked([&](const study::PartProgress& progress_of) {
            const InputLog inputs(InputLog::Threads::own);
            designs::IdentificationData all;
            for (const std::string& file : files) designs::read_identification(file, copy, all);
            for (const std::string& text : bounds)
              all.unknowns.push_back(designs::unknown_of("unknowns", text, copy));
            for (const InputFile& read : inputs.noted()) copy.inputs.push_back(read);
            designs::DataModel model(copy, std::move(all));
            designs::Identification result = designs::identify(model, options, progress_of);
            return std::make_shared<const Found>(Found{std::move(model), std::move(result)});
          }),
          the_case.file()};
}

// A value for each unknown, by its name.
std::map<std::string, double> by_name(const Identification& self, const std::vector<double>& of) {
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < of.size(); ++i)
    values.emplace(self.found->model.data().unknowns[i].name(), of[i]);
  return values;
}

std::map<std::string, std::pair<double, double>> intervals(const Identification& self) {
  std::map<std::string, std::pair<double, double>> limits;
  const auto& profiles = self.found->result.profiles;
  for (std::size_t i = 0; i < profiles.size(); ++i)
    limits.emplace(self.found->model.data().unknowns[i].name(),
                   std::pair(profiles[i].low, profiles[i].high));
  return limits;
}

std::string identified(const Found& found) {
  return designs::identified_case_text(found.model, found.result);
}

std::vector<std::pair<std::string, double>> worst_of_fit(const Identification& self) {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& residual : self.found->result.worst)
    all.emplace_back(designs::name_of(self.found->model, residual), residual.residual);
  return all;
}

std::vector<std::pair<std::string, double>> further_of_fit(const Identification& self) {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& unknown : self.found->result.further)
    all.emplace_back(unknown.variable.name(), unknown.fit.chi_square);
  return all;
}

// Columns of low, middle and high of each reaction, as bands.csv has them.
struct Bands {
  std::shared_ptr<const Found> found;
  std::vector<double> values;
};

std::optional<Table> bands(const Identification& self) {
  const designs::Identification& result = self.found->result;
  if (result.bands.empty()) return std::nullopt;
  Table table;
  table.name = "bands";
  table.rows = result.theta_deg.size();
  auto memory = std::make_shared<Bands>(Bands{self.found, {}});
  for (std::size_t row = 0; row < table.rows; ++row)
    for (const designs::ReactionBand& band : result.bands)
      memory->values.insert(memory->values.end(),
                            {band.low[row], band.middle[row], band.high[row]});
  const ChannelLayout layout(self.found->model.base().pump);
  table.columns.push_back({"theta_deg", "deg", "angle of the shaft", result.theta_deg.data()});
  table.first_of_block = 1;
  for (const designs::ReactionBand& band : result.bands)
    for (const auto& [part, share] :
         {std::pair{"q025", "2.5 %"}, std::pair{"q500", "50 %"}, std::pair{"q975", "97.5 %"}}) {
      const Channel& channel = layout.channels()[band.column];
      table.columns.push_back({channel.name + "_" + part, channel.unit,
                               channel.meaning + ", " + share + " of the posterior below it",
                               memory->values.data() + table.columns.size() - 1,
                               3 * result.bands.size()});
    }
  table.csv = [found = self.found] { return designs::bands_csv(found->model, found->result); };
  table.owner = std::move(memory);
  return table;
}

std::vector<fs::path> report_identification(const Identification& self, const fs::path& folder) {
  return unlocked([&](const study::PartProgress& progress_of) {
    const Found& found = *self.found;
    std::vector<cli::TextFile> files = {
        {"identified.toml", identified(found)},
        {"unknowns.csv", designs::unknowns_csv(found.model, found.result)}};
    if (const std::string text = designs::bands_csv(found.model, found.result); !text.empty())
      files.emplace_back("bands.csv", text);
    return write_report(
        folder, "bentaxis.identify", {&found.model.base()},
        designs::identify_document(found.model, found.result, versions(),
                                   study::describe(found.model.base(), progress_of)),
        {}, files);
  });
}

}  // namespace

void add_identification(py::module_& module) {
  const auto goodness = [](auto member) {
    return [member](const Identification& self) {
      return std::invoke(member, self.found->result.goodness);
    };
  };
  py::class_<Minimum>(module, "Minimum", "A local minimum of the sum of squares.")
      .def_readonly("values", &Minimum::x, "Values of the unknowns, in their order.")
      .def_readonly("sum_of_squares", &Minimum::sum_of_squares, "There.")
      .def_readonly("starts", &Minimum::starts, "Number of starts that ended there.");
  py::class_<Identification>(
      module, "Identification",
      "Result of an identification: parameters of a pump determined from data.")
      .def_property_readonly(
          "unknowns",
          [](const Identification& self) {
            std::vector<std::string> names;
            for (const auto& unknown : self.found->model.data().unknowns)
              names.push_back(unknown.name());
            return names;
          },
          "Names of the unknowns, in their order.")
      .def_property_readonly(
          "values",
          [](const Identification& self) { return by_name(self, self.found->result.fit.x); },
          "Identified values.")
      .def_property_readonly(
          "deviations",
          [](const Identification& self) {
            return by_name(self, self.found->result.information.deviation);
          },
          "Standard deviations, as if the model were linear there; where the fit is refuted, with "
          "all stated uncertainties multiplied by birge_ratio.")
      .def_property_readonly("intervals", &intervals,
                             "95 % limits from profile likelihoods; empty with fit_only and where "
                             "the fit is refuted. Valid only if the stated uncertainties are.")
      .def_property_readonly(
          "sum_of_squares",
          [](const Identification& self) { return self.found->result.fit.sum_of_squares; },
          "Chi-square: sum of squares of all residuals over their uncertainties.")
      .def_property_readonly(
          "degrees_of_freedom", goodness(&designs::GoodnessOfFit::degrees_of_freedom),
          "Degrees of freedom: number of data less number of fitted values; 0: the fit cannot be "
          "tested.")
      .def_property_readonly(
          "p_value", goodness(&designs::GoodnessOfFit::p_value),
          "Probability of a larger sum of squares if model and stated uncertainties are right; "
          "None "
          "without degrees of freedom.")
      .def_property_readonly(
          "refuted", goodness(&designs::GoodnessOfFit::refuted),
          "Whether the data refute the model with these unknowns: p_value below 0.001. There are "
          "then no intervals and no bands.")
      .def_property_readonly("birge_ratio", goodness(&designs::GoodnessOfFit::birge_ratio),
                             "Root of the sum of squares over the degrees of freedom.")
      .def_property_readonly("worst_residuals", &worst_of_fit,
                             "Names of the data with the largest residuals, and the residuals over "
                             "their standard uncertainties, the largest first.")
      .def_property_readonly(
          "further_unknowns", &further_of_fit,
          "Of a refuted fit: parameters that would improve it most if they were "
          "unknown too, each with the sum of squares that would remain, the best "
          "first.")
      .def_property_readonly(
          "minima", [](const Identification& self) { return self.found->result.minima; },
          "Best first.")
      .def_property_readonly(
          "words", [](const Identification& self) { return self.found->result.information.words; },
          "Unknowns that are determined only in combination, or not at all.")
      .def_property_readonly(
          "text",
          [](const Identification& self) {
            return designs::identify_text(self.found->model, self.found->result);
          },
          "Text that the program prints.")
      .def_property_readonly(
          "case",
          [](const Identification& self) {
            return PythonCase(identified(*self.found), self.file, {});
          },
          "The identified pump.")
      .def_property_readonly(
          "bands", &bands,
          "Reactions over the turn with their bands; None with fit_only and where the "
          "fit is refuted.")
      .def("report", &report_identification, py::arg("folder"),
           "Writes the same files as the program; returns their paths.")
      .def(
          "__repr__",
          [](const Identification& self) {
            return "<bentaxis.Identification of " +
                   std::to_string(self.found->model.data().unknowns.size()) + " unknowns>";
          },
          "Number of unknowns.");
  module.def("identify", &identify, py::arg("case"), py::arg("data"),
             py::arg("unknowns") = py::none(), py::kw_only(), py::arg("starts") = 8,
             py::arg("seed") = 1, py::arg("steps") = 2000, py::arg("draws") = 400,
             py::arg("measured") = 0.01, py::arg("fit_only") = false, py::arg("threads") = 0,
             "Determines parameters from printed numbers, windows and records "
             "(docs/identification.md). `data`: a file or several. `unknowns`: further unknowns, "
             "minimum and maximum by name. `fit_only`: least squares only, without profiles, "
             "posterior and leave-one-out. Needs a build with Ceres.");
}

}  // namespace bentaxis::python

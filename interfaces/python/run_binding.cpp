#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bentaxis/files/csv.h"
#include "bentaxis/study/channel_choice.h"
#include "bentaxis/study/lost_digits.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/state_doubts.h"
#include "bentaxis/study/timing.h"
#include "binding.h"
#include "call.h"
#include "choices.h"
#include "python_case.h"
#include "table.h"
#include "values.h"
#include "words.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
using Warnings = std::vector<std::string>;

template <class T>
struct Warned {
  std::shared_ptr<const T> table;
  Warnings implausible, warnings;
};

template <class T>
Table shown(Warned<T>&& found) {
  warn_of_plausibility(found.implausible);
  Table table = table_of(std::move(found.table));
  table.warnings = std::move(found.implausible);
  for (const std::string& text : found.warnings) {
    warn(text);
    table.warnings.push_back(in_python(text));
  }
  return table;
}

// What the program says on standard error of the ports' timing.
void add_timing(const study::PreparedCase& ready, Warnings& warnings) {
  if (!ready.hydraulics) return;
  for (const auto& warning :
       study::timing_warnings(study::timing_rows(ready.the_case, *ready.hydraulics)))
    warnings.push_back(warning.name + ": " + warning.text);
  if (const auto warning = study::accuracy_warning(ready.the_case, *ready.hydraulics))
    warnings.push_back(warning->name + ": " + warning->text);
}

Warned<ResultTable> turn(const Case& the_case, study::Model model,
                         const study::ChannelChoice& channels,
                         const study::PartProgress& progress_of) {
  Warned<ResultTable> found;
  found.implausible = plausibility_texts(the_case);
  const ChannelLayout layout(the_case.pump);
  study::RunOptions options;
  options.model = model;
  if (model == study::Model::multibody)
    options.scene.scene = channels.scene_for(layout, std::nullopt);
  else
    channels.of(layout);  // refuses unknown names
  const study::PreparedCase ready = study::prepare(the_case, progress_of);
  const auto lines = study::rounding_lines(ready.the_case, ready.assumptions(model));
  found.warnings = study::rounding_warnings(lines);
  if (model == study::Model::multibody)
    for (const std::string& text :
         study::multibody_warnings(ready.the_case, ready.assumptions(model), options.scene, lines))
      found.warnings.push_back(text);
  add_timing(ready, found.warnings);
  ResultTable table = study::run(ready, options, progress_of).table;
  if (!channels.all())
    table = select_channels(table, [&](const Channel& c) { return channels.wants(c); });
  found.table = std::make_shared<const ResultTable>(std::move(table));
  return found;
}

Table run(const PythonCase& the_case, const std::string& model, const Texts& channels) {
  const study::ChannelChoice wanted(texts_of(channels, "channels"));
  const study::Model which = model_called(model);
  const Case copy = the_case.copy();
  return shown(unlocked([&](const study::PartProgress& progress_of) {
    return turn(copy, which, wanted, progress_of);
  }));
}

// Arrays as the table that a file of states is read to; its lines are counted as Python does.
NumericTable numeric_table(const py::handle& arrays) {
  NumericTable table;
  std::size_t rows = 0;
  std::vector<py::array_t<double>> columns;
  for (const auto& [name, value] : items_of(arrays, "states")) {
    auto column = py::array_t<double, py::array::forcecast>::ensure(value);
    if (!column || column.ndim() != 1) {
      PyErr_Clear();
      throw InputError("states: " + name +
                       " must be a list of numbers or an array of one dimension");
    }
    const auto size = static_cast<std::size_t>(column.size());
    if (!columns.empty() && size != rows)
      throw InputError("states: " + name + " has " + std::to_string(size) + " numbers, " +
                       table.header.front() + " has " + std::to_string(rows));
    rows = size;
    table.header.push_back(name);
    columns.push_back(std::move(column));
  }
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<double> row;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      row.push_back(columns[c].at(static_cast<py::ssize_t>(i)));
      if (!std::isfinite(row.back()))
        throw InputError("states:" + std::to_string(i) + ": " + table.header[c] +
                         " must be a finite number");
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(static_cast<unsigned>(i));
  }
  return table;
}

Table run_states(const PythonCase& the_case, const Motion& states, const std::string& model,
                 const Texts& channels) {
  const study::ChannelChoice wanted(texts_of(channels, "channels"));
  study::RunOptions options;
  options.model = model_called(model);
  const bool arrays = py::hasattr(states, "items");
  const NumericTable given = arrays ? numeric_table(states) : NumericTable{};
  const std::vector<std::string> files =
      arrays ? std::vector<std::string>{"states"} : paths_of(states, "states");
  if (files.size() != 1)
    throw InputError("states: must be a mapping from columns to arrays, or one path");
  const std::string& file = files.front();
  const Case copy = the_case.copy();
  return shown(unlocked([&](const study::PartProgress& progress_of) {
    Warned<MotionTable> found;
    found.implausible = plausibility_texts(copy);
    std::vector<Channel> there = ChannelLayout(copy.pump).channels();
    for (const Channel& channel : motion_channels()) there.push_back(channel);
    wanted.of(there);  // refuses unknown names
    const study::PreparedCase ready = study::prepare(copy, progress_of);
    const States read = arrays ? states_of(given, file, file, ready.the_case, ready.pressure)
                               : read_states(file, ready.the_case, ready.pressure);
    add_timing(ready, found.warnings);
    for (const auto& doubt : study::state_doubts(ready.the_case, read))
      found.warnings.push_back(doubt.name + ": " + doubt.text);
    MotionTable table = study::run_states(ready, read, options, progress_of);
    table.results = select_channels(table.results,
                                    [&](const Channel& channel) { return wanted.wants(channel); });
    found.table = std::make_shared<const MotionTable>(std::move(table));
    return found;
  }));
}

}  // namespace

void add_runs(py::module_& module) {
  module.def(
      "run", &run, py::arg("case"), py::arg("model") = "analytic", py::arg("channels") = py::none(),
      "Reactions over one turn at constant speed by one model, \"analytic\" or \"multibody\". "
      "`channels`: only these quantities (\"Rs\") or columns (\"Rs_1_z2_N\"), by the smallest "
      "scene that computes them.");
  module.def(
      "run_states", &run_states, py::arg("case"), py::arg("states"), py::arg("model") = "analytic",
      py::arg("channels") = py::none(),
      "Reactions at given states of shaft and block: a CSV file (docs/motion.md) or arrays by "
      "the names of its columns. Messages count arrays from 0.");
}

}  // namespace bentaxis::python

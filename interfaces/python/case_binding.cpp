#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <set>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/study/plausibility.h"
#include "binding.h"
#include "python_case.h"
#include "report.h"
#include "shipped_cases.h"
#include "values.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;
using study::PlausibilityWarning;

PythonCase::Changes changes_of(const py::handle& values) {
  PythonCase::Changes changes;
  for (const auto& [key, value] : items_of(values, "changes"))
    changes.emplace_back(key, toml_of(value, key));
  return changes;
}

const Parameter& known(const std::string& key) {
  if (const Parameter* const parameter = parameter_called(key)) return *parameter;
  const std::vector<std::string> keys = all_keys();
  throw py::key_error(
      "no parameter is called " + key +
      suggestion(key, {keys.begin(), keys.end()}, "listed by bentaxis.parameters()"));
}

py::object value_in(const PythonCase& the_case, const std::string& key) {
  known(key);
  const auto value = the_case.value(key);
  return value ? python_of(*value) : py::none();
}

std::string range_text(const Parameter& parameter) {
  if (!parameter.range_words.empty()) return parameter.range_words;
  if (!parameter.words.empty()) return "one of " + joined(parameter.words);
  return parameter.range.text();
}

void add_class(py::module_& module) {
  py::class_<PythonCase>(module, "Case",
                         "A case: pump, operating point and chamber pressure. A mapping from the "
                         "keys of the case file, such as \"pump.tilt_deg\", to values in the units "
                         "of the file. Each computation uses a copy made at the call.")
      .def("__getitem__", &value_in, py::arg("key"),
           "Value of a parameter in the file's unit; None where it has none in this case.")
      .def(
          "__setitem__",
          [](PythonCase& self, const std::string& key, const CaseValue& value) {
            self.change({{key, toml_of(value, key)}});
          },
          py::arg("key"), py::arg("value"),
          "Changes a parameter as if its file said so: its range is checked, and defaults that "
          "depend on it are updated.")
      .def(
          "update",
          [](PythonCase& self, const CaseValues& values) { self.change(changes_of(values)); },
          py::arg("changes"),
          "Changes several parameters at once, where single changes would be refused. All are "
          "changed or none.")
      .def(
          "__contains__",
          [](const PythonCase& self, const std::string& key) {
            return self.value(key).has_value();
          },
          py::arg("key"), "Whether a parameter has a value in this case.")
      .def("keys", &PythonCase::keys, "Keys of the parameters that are active in this case.")
      .def(
          "__iter__", [](const PythonCase& self) { return py::iter(py::cast(self.keys())); },
          "Iterates over keys().")
      .def(
          "__len__", [](const PythonCase& self) { return self.keys().size(); }, "Number of keys().")
      .def(
          "items",
          [](const PythonCase& self) {
            std::vector<std::pair<std::string, py::object>> items;
            for (const std::string& key : self.keys()) items.emplace_back(key, value_in(self, key));
            return items;
          },
          "Keys with their values.")
      .def(
          "validate", [](const PythonCase& self) { validate(self.get()); },
          "Checks the range of every parameter and their consistency; raises InputError.")
      .def(
          "doubts", [](const PythonCase& self) { return study::plausibility(self.get()).warnings; },
          "Plausibility warnings of the case (docs/plausibility.md).")
      .def(
          "summary",
          [](const PythonCase& self) { return study::plausibility(self.get()).summary(); },
          "The pump in a line: displacement, flow, torque, speed, pressure.")
      .def(
          "write",
          [](const PythonCase& self, const fs::path& path) {
            write_file(path, case_text(self.get()));
          },
          py::arg("path"), "Writes a case file; reading it gives the same case.")
      .def(
          "text", [](const PythonCase& self) { return case_text(self.get()); },
          "Text of the case file.")
      .def(
          "copy", [](const PythonCase& self) { return self; }, "Copy of the case.")
      .def(
          "__copy__", [](const PythonCase& self) { return self; }, "As copy().")
      .def(
          "__deepcopy__", [](const PythonCase& self, const py::object&) { return self; },
          py::arg("memo"), "As copy().")
      .def(
          "__eq__",
          [](const PythonCase& self, const py::object& other) {
            return py::isinstance<PythonCase>(other) &&
                   case_text(self.get()) == case_text(other.cast<const PythonCase&>().get());
          },
          py::arg("other"), "Whether both write the same file.")
      .def(
          "__repr__",
          [](const PythonCase& self) {
            return "<bentaxis.Case \"" + self.get().name + "\" of " + self.file().string() + ">";
          },
          "Name and file.")
      .def_property_readonly(
          "name", [](const PythonCase& self) { return self.get().name; }, "Name of the case.")
      .def_property_readonly(
          "file", [](const PythonCase& self) { return self.file().string(); },
          "Path of its file, absolute.")
      .def(py::pickle(
          [](const PythonCase& self) {
            return py::make_tuple(self.text(), self.file().string(), self.changes(), self.sha256());
          },
          [](const py::tuple& state) {
            return PythonCase(state[0].cast<std::string>(), state[1].cast<std::string>(),
                              state[2].cast<PythonCase::Changes>(),
                              state.size() > 3 ? state[3].cast<std::string>() : std::string());
          }))
      .attr("__hash__") = py::none();
}

}  // namespace

void add_case(py::module_& module) {
  py::class_<PlausibilityWarning>(
      module, "Doubt",
      "A plausibility warning: a value, or a combination of values, that is implausible.")
      .def_readonly("code", &PlausibilityWarning::code, "Stable short name: \"tilt-in-radians\".")
      .def_readonly("text", &PlausibilityWarning::text,
                    "The key with its value, the limit and its reason.")
      .def_readonly("reason", &PlausibilityWarning::reason,
                    "Reason why the value is intended, where the case gives one.")
      .def(
          "__repr__",
          [](const PlausibilityWarning& self) {
            return "<bentaxis.Doubt " + self.code + ": " + self.text + ">";
          },
          "Name and text.");
  py::class_<Parameter>(module, "Parameter", "A parameter of a case file.")
      .def_property_readonly(
          "unit", [](const Parameter& self) { return std::string(self.unit.name); },
          "Unit of its value; \"\" where it has none.")
      .def_readonly("symbol", &Parameter::symbol, "Symbol in the paper or in the documentation.")
      .def_readonly("meaning", &Parameter::meaning, "Meaning of the parameter.")
      .def_property_readonly("range", &range_text, "Allowed values.")
      .def_readonly("words", &Parameter::words, "Allowed words, for a choice.");
  add_class(module);
  module.def(
      "read_case",
      [](const fs::path& path, const CaseValues& changes) {
        return PythonCase::read(cli::case_file(path.string(), shipped("cases")),
                                changes_of(changes));
      },
      py::arg("path"), py::arg("changes") = py::none(),
      "Reads a case file, or the shipped case of this name (cases()). Files that the case names "
      "are found from its own directory. `changes`: as if the file said so.");
  module.def(
      "parse_case",
      [](const std::string& text, const fs::path& path) { return PythonCase(text, path, {}); },
      py::arg("text"), py::arg("path") = "case.toml",
      "Reads a case from a text. `path` appears in messages, and files named in the text are found "
      "from its directory.");
  module.def("parameter", &known, py::arg("key"), py::return_value_policy::reference,
             "Unit, symbol, meaning and range of a parameter.");
  module.def("parameters", &all_keys, "All keys that a case file may have.");
}

}  // namespace bentaxis::python

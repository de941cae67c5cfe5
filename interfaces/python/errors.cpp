#include <pybind11/pybind11.h>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/plausibility.h"
#include "binding.h"
#include "call.h"
#include "words.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;

// They live as long as the module, which Python never unloads.
PyObject* input_error = nullptr;
PyObject* computation_error = nullptr;
PyObject* warning = nullptr;
PyObject* plausibility_warning = nullptr;

PyObject* new_class(py::module_& module, const char* name, const char* doc, PyObject* base) {
  PyObject* const made =
      PyErr_NewExceptionWithDoc((std::string("bentaxis.") + name).c_str(), doc, base, nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.attr(name) = py::handle(made);
  return made;
}

}  // namespace

void warn(const std::string& text) {
  if (PyErr_WarnEx(warning, in_python(text).c_str(), 1) != 0) throw py::error_already_set();
}

std::vector<std::string> plausibility_texts(const Case& the_case) {
  std::vector<std::string> texts;
  for (const study::PlausibilityWarning& doubt : study::plausibility(the_case).warnings)
    texts.push_back(in_python(doubt.code + ": " + doubt.text));
  return texts;
}

void warn_of_plausibility(const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (PyErr_WarnEx(plausibility_warning, text.c_str(), 1) != 0) throw py::error_already_set();
}

std::vector<std::string> warned_of(const Case& the_case) {
  std::vector<std::string> texts = plausibility_texts(the_case);
  warn_of_plausibility(texts);
  return texts;
}

void warn_of(const std::vector<report::Warning>& warnings, std::vector<std::string>& texts) {
  for (const report::Warning& warning : warnings) {
    texts.push_back(warning.name + ": " + warning.text);
    warn(texts.back());
  }
}

void add_errors(py::module_& module) {
  input_error = new_class(module, "InputError",
                          "An input (file, key or argument) cannot be used. The message names it, "
                          "its value and what is allowed.",
                          PyExc_ValueError);
  computation_error = new_class(module, "ComputationError",
                                "A computation on valid input failed: which model, where, and why.",
                                PyExc_RuntimeError);
  warning = new_class(module, "DoubtWarning",
                      "A result was computed, but with a warning: digits lost to round-off, port "
                      "timing outside its limits, implausible states.",
                      PyExc_UserWarning);
  plausibility_warning = new_class(
      module, "PlausibilityWarning",
      "A case is valid but implausible: a plausibility warning, as listed by `Case.doubts()`.",
      warning);
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 wants it so
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      PyErr_SetString(input_error, in_python(error.what()).c_str());
    } catch (const ComputationError& error) {
      PyErr_SetString(computation_error, in_python(error.what()).c_str());
    }
  });
}

}  // namespace bentaxis::python

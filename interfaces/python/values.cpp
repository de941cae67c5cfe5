#include "values.h"

#include <pybind11/stl/filesystem.h>

#include <optional>

#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;

std::string type_of(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

bool is_path(const py::handle& value) {
  return py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__");
}

std::string text_of(const py::handle& value, const std::string& what) try {
  return py::cast<std::filesystem::path>(value).string();
} catch (const py::cast_error&) {
  throw InputError(what + ": must be a text that UTF-8 can encode, without a null character");
}

// A number of Python's or numpy's; what is neither raises nothing.
bool is_number(const py::handle& value) {
  return PyIndex_Check(value.ptr()) != 0 || PyFloat_Check(value.ptr()) != 0 ||
         py::hasattr(value, "__float__");
}

// numpy's bool is none of Python's.
bool is_flag(const py::handle& value) {
  return py::isinstance<py::bool_>(value) || type_of(value) == "bool_" || type_of(value) == "bool";
}

std::string number_of(const py::handle& value) {
  if (PyIndex_Check(value.ptr()) != 0)
    return py::str(py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr())));
  const double number = py::float_(py::reinterpret_borrow<py::object>(value));
  std::string text = number_text(number);
  if (text.empty() || number != number) text = "nan";
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

bool is_list(const py::handle& value) {
  return !py::isinstance<py::str>(value) && !py::isinstance<py::bytes>(value) &&
         PySequence_Check(value.ptr()) != 0 && PyMapping_Check(value.ptr()) != 0 &&
         !py::isinstance<py::dict>(value);
}

// Of numpy's arrays; nothing of what is none.
std::optional<int> dimensions_of(const py::handle& value) {
  if (!py::hasattr(value, "ndim") || !py::hasattr(value, "item")) return std::nullopt;
  return py::cast<int>(value.attr("ndim"));
}

std::vector<std::string> list_of(const py::handle& values, const std::string& what,
                                 bool (*one)(const py::handle&), const char* wanted) {
  const auto text = [&](const py::handle& value) -> std::string {
    if (!one(value))
      throw InputError(what + ": must be " + wanted + " or a list of them, not " + type_of(value));
    return text_of(value, what);
  };
  if (values.is_none()) return {};
  if (one(values)) return {text(values)};
  if (!py::isinstance<py::iterable>(values)) text(values);
  std::vector<std::string> list;
  for (const py::handle value : py::reinterpret_borrow<py::object>(values))
    list.push_back(text(value));
  return list;
}

}  // namespace

std::vector<std::string> texts_of(const py::handle& texts, const std::string& what) {
  return list_of(
      texts, what, [](const py::handle& value) { return py::isinstance<py::str>(value); },
      "a text");
}

std::vector<std::string> paths_of(const py::handle& paths, const std::string& what) {
  return list_of(paths, what, is_path, "a path");
}

std::string toml_of(const py::handle& value, const std::string& what) {
  // An array without dimensions counts as a list for Python, and has no elements.
  if (dimensions_of(value) == 0 && is_list(value)) return toml_of(value.attr("item")(), what);
  if (is_flag(value))
    return py::cast<bool>(py::bool_(py::reinterpret_borrow<py::object>(value))) ? "true" : "false";
  if (is_path(value)) return toml_text(text_of(value, what));
  if (is_list(value))
    return "[" +
           joined(py::reinterpret_borrow<py::object>(value), ", ",
                  [&](const py::handle& one) { return toml_of(one, what); }) +
           "]";
  if (is_number(value)) return number_of(value);
  throw InputError(what + ": must be a number, a text, a bool or a list of them, not " +
                   type_of(value));
}

std::vector<std::pair<std::string, py::object>> items_of(const py::handle& mapping,
                                                         const std::string& what) {
  std::vector<std::pair<std::string, py::object>> items;
  if (mapping.is_none()) return items;
  if (!py::hasattr(mapping, "items"))
    throw InputError(what + ": must be a mapping from names to values, not " + type_of(mapping));
  for (const py::handle item : mapping.attr("items")()) {
    const auto pair = py::cast<std::pair<py::object, py::object>>(item);
    if (!py::isinstance<py::str>(pair.first))
      throw InputError(what + ": names must be texts, not " + type_of(pair.first));
    items.emplace_back(py::cast<std::string>(pair.first), pair.second);
  }
  return items;
}

std::string values_text(const std::string& name, const py::handle& values) {
  if (py::isinstance<py::str>(values)) return text_of(values, name);
  const auto one = [&](const py::handle& value) {
    return py::isinstance<py::str>(value) ? text_of(value, name) : toml_of(value, name);
  };
  const std::optional<int> dimensions = dimensions_of(values);
  if (dimensions > 1)
    throw InputError(name + ": must be a number, a text or a list of them, not an array of " +
                     std::to_string(*dimensions) + " dimensions");
  if (dimensions == 0 || !py::isinstance<py::iterable>(values)) return one(values);
  std::string text;
  for (const py::handle value : py::reinterpret_borrow<py::object>(values))
    text += (text.empty() ? "" : ",") + one(value);
  return text;
}

py::object python_of(const Value& value) {
  return std::visit(
      [](const auto& held) -> py::object {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::array<double, 2>>)
          return py::make_tuple(held[0], held[1]);
        else
          return py::cast(held);
      },
      value);
}

}  // namespace bentaxis::python

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "binding.h"
#include "call.h"
#include "table.h"
#include "table_pickle.h"
#include "values.h"

namespace bentaxis::python {
namespace {

namespace py = pybind11;
using Array = py::array_t<double>;

// A look at memory that `owner` keeps; the array keeps `owner`.
Array view(const py::object& owner, const double* first, std::vector<py::ssize_t> shape,
           std::vector<py::ssize_t> strides) {
  Array array(std::move(shape), std::move(strides), first, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::ssize_t bytes(std::size_t numbers) {
  return static_cast<py::ssize_t>(numbers * sizeof(double));
}

Array column(const py::object& self, const std::string& name) {
  const auto& table = self.cast<const Table&>();
  const Column& one = table.column(name);
  return view(self, one.first, {static_cast<py::ssize_t>(table.rows)}, {bytes(one.stride)});
}

std::vector<std::string> names(const Table& table) {
  std::vector<std::string> names;
  for (const Column& one : table.columns) names.push_back(one.name);
  return names;
}

// All that lies in one block of memory, row by row.
Array values(const py::object& self) {
  const auto& table = self.cast<const Table&>();
  const std::size_t width = table.columns.size() - table.first_of_block;
  if (width == 0) return Array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(table.rows), 0});
  const Column& one = table.columns[table.first_of_block];
  return view(self, one.first,
              {static_cast<py::ssize_t>(table.rows), static_cast<py::ssize_t>(width)},
              {bytes(one.stride), bytes(1)});
}

py::object as_array(const Table& table, const py::object& dtype, const py::object& copy) {
  if (!copy.is_none() && !copy.cast<bool>())
    throw py::value_error("a table is not one array in memory: a copy is needed");
  const std::size_t width = table.columns.size();
  Array all({table.rows, width});
  double* to = all.mutable_data();
  for (std::size_t row = 0; row < table.rows; ++row)
    for (const Column& one : table.columns) *to++ = one.first[row * one.stride];
  if (dtype.is_none()) return all;
  return all.attr("astype")(dtype);
}

DataFrame to_pandas(const py::object& self) {
  const auto& table = self.cast<const Table&>();
  py::dict columns, units;
  for (const Column& one : table.columns) {
    columns[py::str(one.name)] = column(self, one.name);
    units[py::str(one.name)] = one.unit;
  }
  py::object frame = py::module_::import("pandas").attr("DataFrame")(columns);
  if (table.first_is_index && !table.columns.empty())
    frame = frame.attr("set_index")(table.columns.front().name);
  frame.attr("attrs")["units"] = units;
  return frame;
}

void write_csv(const Table& table, const std::filesystem::path& path) {
  unlocked([&](const study::PartProgress&) { write_file(path, table.csv()); });
}

void add_channel(py::module_& module) {
  py::class_<Channel>(module, "Channel",
                      "One scalar result: quantity, body, acting body, point, frame and unit.")
      .def_readonly("name", &Channel::name, "Name of the column: \"Rs_1_x2_N\".")
      .def_readonly("quantity", &Channel::quantity, "\"Rs\".")
      .def_readonly("meaning", &Channel::meaning, "In words.")
      .def_readonly("equation", &Channel::equation, "Equation of Roccatello and Nervegna (2009).")
      .def_readonly("piston", &Channel::piston,
                    "Piston, from 1; 0 where the channel belongs to none.")
      .def_readonly("axis", &Channel::axis, "\"x2\".")
      .def_readonly("frame", &Channel::frame, "\"S2\".")
      .def_readonly("on_body", &Channel::on_body, "Body on which it acts.")
      .def_readonly("by_body", &Channel::by_body, "Body that exerts it.")
      .def_readonly("point", &Channel::point, "Where it acts.")
      .def_readonly("unit", &Channel::unit, "\"N\".")
      .def_readonly("group", &Channel::group, "Channels of one group share one peak.")
      .def(
          "__repr__", [](const Channel& self) { return "<bentaxis.Channel " + self.name + ">"; },
          "Its name.");
}

}  // namespace

void add_tables(py::module_& module) {
  add_channel(module);
  py::class_<Table, std::shared_ptr<Table>>(
      module, "Table",
      "Columns of numbers by name. Arrays are read-only views of the memory of the computation, "
      "which is kept as long as any view exists; nothing is copied. NaN: not computed.")
      .def("__getitem__", &column, py::arg("name"),
           "A column as an array; its name may lack the unit and, of a quantity of one "
           "component, the axis: \"Td_z1_Nm\", \"Td_z1\", \"Td_Nm\", \"Td\".")
      .def(
          "__contains__",
          [](const Table& self, const py::object& name) {
            return py::isinstance<py::str>(name) && self.has(name.cast<std::string>());
          },
          py::arg("name"), "Whether there is such a column: whether [name] gives one.")
      .def(
          "__iter__", [](const Table& self) { return py::iter(py::cast(names(self))); },
          "Over names.")
      .def(
          "__len__", [](const Table& self) { return self.rows; }, "Number of rows.")
      .def("keys", &names, "As names.")
      .def_property_readonly("names", &names,
                             "Names of the columns; the first is the angle or the time of a row.")
      .def_readonly("name", &Table::name, "Model that computed it.")
      .def("__array__", &as_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none(),
           "All columns as one array, row by row, in the order of `names`; a copy.")
      .def_readonly("warnings", &Table::warnings, "Warnings about the case or the results.")
      .def_property_readonly("values", &values,
                             "All columns of `channels` as one array, row by row.")
      .def_property_readonly(
          "channels",
          [](const Table& self) {
            std::vector<std::string> names;
            for (std::size_t i = self.first_of_block; i < self.columns.size(); ++i)
              names.push_back(self.columns[i].name);
            return names;
          },
          "Names of the columns of `values`.")
      .def(
          "unit", [](const Table& self, const std::string& name) { return self.column(name).unit; },
          py::arg("name"), "Unit of a column.")
      .def(
          "meaning",
          [](const Table& self, const std::string& name) { return self.column(name).meaning; },
          py::arg("name"), "Description of a column: body, acting body, point, frame.")
      .def(
          "channel",
          [](const Table& self, const std::string& name) { return self.column(name).channel; },
          py::arg("name"),
          "Description of a column as an object; None where it is not a result of a model.")
      .def("to_pandas", &to_pandas,
           "A pandas.DataFrame over angle or time, units in its attrs. Needs pandas.")
      .def("write_csv", &write_csv, py::arg("path"),
           "Writes the same CSV file as the program: the shortest text that reads back to the same "
           "numbers.")
      .def(
          "__reduce__",
          [](const py::object& self) {
            const py::object make = py::module_::import("bentaxis").attr("_table");
            return py::make_tuple(make, py::make_tuple(state_of(self.cast<const Table&>())));
          },
          "For pickles, which have a copy.")
      .def(
          "__repr__",
          [](const Table& self) {
            return "<bentaxis.Table \"" + self.name + "\", " + std::to_string(self.rows) +
                   " rows of " + std::to_string(self.columns.size()) + " columns>";
          },
          "Name and size.");
  module.def("_table", &table_in, py::arg("state"), "A table from a pickle.");
}

}  // namespace bentaxis::python

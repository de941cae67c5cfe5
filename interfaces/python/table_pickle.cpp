// Tables in pickles: their numbers, and what is known of each column.
#include "table_pickle.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

namespace bentaxis::python {
namespace {

namespace py = pybind11;

py::object packed(const std::optional<Channel>& channel) {
  if (!channel) return py::none();
  const Channel& c = *channel;
  return py::make_tuple(c.name, c.quantity, c.meaning, c.equation, c.piston, c.axis, c.frame,
                        c.on_body, c.by_body, c.point, c.unit, c.unit_in_si, c.group,
                        static_cast<int>(c.kind));
}

std::optional<Channel> unpacked(const py::object& state) {
  if (state.is_none()) return std::nullopt;
  const auto all = state.cast<py::tuple>();
  std::size_t next = 0;
  const auto text = [&] { return all[next++].cast<std::string>(); };
  Channel c;
  for (std::string* const one : {&c.name, &c.quantity, &c.meaning, &c.equation}) *one = text();
  c.piston = all[next++].cast<int>();
  for (std::string* const one : {&c.axis, &c.frame, &c.on_body, &c.by_body, &c.point, &c.unit})
    *one = text();
  c.unit_in_si = all[next++].cast<double>();
  c.group = text();
  c.kind = static_cast<ChannelKind>(all[next].cast<int>());
  return c;
}

}  // namespace

py::tuple state_of(const Table& table) {
  py::list columns;
  for (const Column& one : table.columns)
    columns.append(py::make_tuple(one.name, one.unit, one.meaning, packed(one.channel)));
  const std::size_t width = table.columns.size();
  py::array_t<double> numbers({table.rows, width});
  double* to = numbers.mutable_data();
  for (std::size_t row = 0; row < table.rows; ++row)
    for (const Column& one : table.columns) *to++ = one.first[row * one.stride];
  return py::make_tuple(table.name, columns, numbers, table.first_is_index, table.first_of_block,
                        table.warnings);
}

Table table_in(const py::tuple& state) {
  std::vector<Column> columns;
  for (const py::handle one : state[1]) {
    const auto parts = one.cast<py::tuple>();
    columns.push_back({parts[0].cast<std::string>(), parts[1].cast<std::string>(),
                       parts[2].cast<std::string>(), nullptr, 1, unpacked(parts[3])});
  }
  const auto numbers = state[2].cast<py::array_t<double, py::array::c_style>>();
  Table table = table_of(state[0].cast<std::string>(), std::move(columns),
                         {numbers.data(), numbers.data() + numbers.size()},
                         static_cast<std::size_t>(numbers.shape(0)), state[3].cast<bool>(),
                         state[4].cast<std::size_t>());
  if (state.size() > 5) table.warnings = state[5].cast<std::vector<std::string>>();  // since 1.1.0
  return table;
}

}  // namespace bentaxis::python

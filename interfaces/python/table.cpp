#include "table.h"

#include <pybind11/pybind11.h>

#include <set>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"

namespace bentaxis::python {
namespace {

std::string meaning_of(const Channel& c) {
  std::string text = c.meaning;
  if (!c.on_body.empty()) text += " on " + c.on_body;
  if (!c.by_body.empty()) text += " by " + c.by_body;
  const bool bare = c.point.starts_with("about") || c.point.starts_with("from");
  if (!c.point.empty()) text += (bare ? ", " : ", at ") + c.point;
  if (!c.axis.empty()) text += ", along " + c.axis;
  if (!c.frame.empty()) text += " in " + c.frame;
  return text;
}

Column column_of(const Channel& channel, const double* first, std::size_t stride) {
  return {channel.name, channel.unit, meaning_of(channel), first, stride, channel};
}

Column column_of(const bentaxis::Column& of, const double* first, std::size_t stride) {
  return {of.name, of.unit, of.meaning, first, stride};
}

// Short names: without the unit, and of a quantity of one component its symbol, with or without it.
bool is_called(const Column& column, const std::string& name) {
  const std::string unit = column.unit.empty() ? "" : "_" + column.unit;
  if (column.name == name + unit || column.name + unit == name) return true;
  if (!column.channel) return false;
  return name == column.channel->quantity || name == column.channel->quantity + unit;
}

void add_channels(Table& table, const ResultTable& of) {
  table.first_of_block = table.columns.size();
  for (std::size_t i = 0; i < of.columns(); ++i)
    table.columns.push_back(column_of(of.channels[i], of.values.data() + i, of.columns()));
}

// By its name, or by a short name that only one has.
const Column* column_called(const std::vector<Column>& columns, const std::string& wanted) {
  const Column* found = nullptr;
  std::size_t called = 0;
  for (const Column& one : columns) {
    if (one.name == wanted) return &one;
    if (!is_called(one, wanted)) continue;
    ++called;
    found = &one;
  }
  return called == 1 ? found : nullptr;
}

}  // namespace

bool Table::has(const std::string& wanted) const {
  return column_called(columns, wanted) != nullptr;
}

const Column& Table::column(const std::string& wanted) const {
  if (const Column* const found = column_called(columns, wanted)) return *found;
  std::set<std::string> names;
  for (const Column& one : columns) names.insert(one.name);
  throw pybind11::key_error("no column is called " + wanted +
                            suggestion(wanted, names, "listed by names"));
}

Table table_of(std::shared_ptr<const ResultTable> of) {
  Table table;
  table.name = of->name;
  table.rows = of->rows();
  table.columns.push_back(column_of(state_column("theta_deg"), of->theta_deg.data(), 1));
  add_channels(table, *of);
  table.csv = [of] { return to_csv(*of); };
  table.owner = std::move(of);
  return table;
}

Table table_of(std::shared_ptr<const MotionTable> of) {
  Table table;
  table.name = of->results.name;
  table.rows = of->results.rows();
  const std::size_t width = of->state_names.size();
  for (std::size_t i = 0; i < width; ++i) {
    bentaxis::Column state = state_column(of->state_names[i]);
    // Pressures of the chambers are given in states and stand among the results too.
    if (const std::size_t same = of->results.find(state.name); same < of->results.columns())
      state = {state.name, of->results.channels[same].meaning, of->results.channels[same].unit};
    table.columns.push_back(column_of(state, of->states.data() + i, width));
  }
  add_channels(table, of->results);
  table.csv = [of] { return to_csv(*of); };
  table.owner = std::move(of);
  return table;
}

Table oil_table_of(std::shared_ptr<const Trajectory> of, const std::string& name) {
  Table table;
  table.name = name;
  table.rows = of->table.results.rows();
  table.columns.push_back(
      column_of(state_column("time_s"), of->table.states.data(), of->table.state_names.size()));
  table.first_of_block = 1;
  const std::vector<OilColumn>& columns = of->oil->columns;
  for (std::size_t i = 0; i < columns.size(); ++i)
    table.columns.push_back(column_of(columns[i], of->oil->values.data() + i, columns.size()));
  table.csv = [of] { return oil_csv(*of); };
  table.owner = std::move(of);
  return table;
}

Table table_of(std::string name, std::vector<Column> columns, std::vector<double> numbers,
               std::size_t rows, bool first_is_index, std::size_t first_of_block) {
  const auto memory = std::make_shared<const std::vector<double>>(std::move(numbers));
  Table table;
  table.name = std::move(name);
  table.rows = rows;
  table.columns = std::move(columns);
  table.first_is_index = first_is_index;
  table.first_of_block = first_of_block;
  const std::size_t width = table.columns.size();
  std::string head;
  for (std::size_t i = 0; i < width; ++i) {
    table.columns[i].first = memory->data() + i;
    table.columns[i].stride = width;
    head += (i == 0 ? "" : ",") + table.columns[i].name;
  }
  table.csv = [memory, head, width] {
    std::string text = head + "\n";
    for (std::size_t i = 0; i < memory->size(); ++i) {
      append_number(text, (*memory)[i]);
      text += (i + 1) % width == 0 ? '\n' : ',';
    }
    return text;
  };
  table.owner = memory;
  return table;
}

}  // namespace bentaxis::python

#include "table.h"

#include <pybind11/pybind11.h>

#include <map>
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

// The unit that a name ends with, and what columns without a channel are.
Column state_column(const std::string& name, const double* first, std::size_t stride) {
  static const std::map<std::string, std::string> units = {{"rad_per_s2", "rad/s2"},
                                                           {"l_per_min", "l/min"},
                                                           {"_deg", "deg"},
                                                           {"_rpm", "rpm"},
                                                           {"_s", "s"},
                                                           {"_bar", "bar"},
                                                           {"_N", "N"},
                                                           {"_Nm", "Nm"},
                                                           {"_kW", "kW"},
                                                           {"_urad", "urad"},
                                                           {"_um", "um"},
                                                           {"_mm", "mm"},
                                                           {"_cm3", "cm3"},
                                                           {"_percent", "%"},
                                                           {"_C", "C"},
                                                           {"_m_per_s", "m/s"}};
  static const std::map<std::string, std::string> meanings = {
      {"theta_deg", "angle of the shaft"},
      {"psi_deg", "angle of the block"},
      {"time_s", "time"},
      {"shaft_rpm", "speed of the shaft"},
      {"block_rpm", "speed of the block"},
      {"motor_rpm", "speed of the motor's rotor"},
      {"theta_rpm", "speed of the shaft"},
      {"psi_rpm", "speed of the block"},
      {"theta_rad_per_s2", "acceleration of the shaft"},
      {"psi_rad_per_s2", "acceleration of the block"},
      {"suction_bar", "pressure in the suction port, gauge"},
      {"delivery_bar", "pressure in the delivery port, gauge"}};
  Column column{name, "", "", first, stride};
  std::size_t longest = 0;
  for (const auto& [end, unit] : units)
    if (end.size() > longest && name.ends_with(end)) {
      longest = end.size();
      column.unit = unit;
    }
  const auto known = meanings.find(name);
  column.meaning = known != meanings.end()  ? known->second
                   : name.starts_with("p_") ? "pressure in a chamber, gauge"
                                            : "";
  return column;
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

}  // namespace

namespace {

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
  throw pybind11::key_error("no column is called " + wanted + suggestion(wanted, names));
}

Table table_of(std::shared_ptr<const ResultTable> of) {
  Table table;
  table.name = of->name;
  table.rows = of->rows();
  table.columns.push_back(state_column("theta_deg", of->theta_deg.data(), 1));
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
  for (std::size_t i = 0; i < width; ++i)
    table.columns.push_back(state_column(of->state_names[i], of->states.data() + i, width));
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
      state_column("time_s", of->table.states.data(), of->table.state_names.size()));
  table.first_of_block = 1;
  for (std::size_t i = 0; i < of->oil->columns.size(); ++i) {
    Column column =
        state_column(of->oil->columns[i].name, of->oil->values.data() + i, of->oil->columns.size());
    column.meaning = of->oil->columns[i].meaning;
    table.columns.push_back(std::move(column));
  }
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

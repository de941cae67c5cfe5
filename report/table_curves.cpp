// Curves of tables of results.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/report/document.h"
#include "thinned.h"

namespace bentaxis::report {
namespace {

using Columns = std::vector<std::pair<std::string, Values>>;

// use(name, values) of a table's curves.
template <class Use>
void for_each_column(const ResultTable& table, const Use& use) {
  for (const Channel& channel : table.channels)
    if (channel.kind != ChannelKind::check) use(channel.name, values_of(table, channel.name));
}

template <class Use>
void for_each_difference(const ResultTable& first, const ResultTable& second, const Use& use) {
  for (std::size_t a = 0; a < first.columns(); ++a) {
    const std::size_t b = second.find(first.channels[a].name);
    const ChannelKind kind = first.channels[a].kind;
    if (b == second.columns() || kind == ChannelKind::check || kind == ChannelKind::input) continue;
    Values difference;
    difference.reserve(first.rows());
    for (std::size_t row = 0; row < first.rows(); ++row)
      difference.push_back(second.at(row, b) - first.at(row, a));
    use(first.channels[a].name, std::move(difference));
  }
}

// use(columns, name, values) of every curve once; columns are those of `curves` that it belongs to.
template <class Use>
void for_each_curve(const std::vector<TablePair>& pairs, Curves& curves, const Use& use) {
  std::set<std::pair<const Columns*, std::string>> used;
  const auto use_in = [&](Columns& columns) {
    return [&](const std::string& name, Values values) {
      if (used.emplace(&columns, name).second) use(columns, name, std::move(values));
    };
  };
  for (const auto& [first, second] : pairs) {
    for_each_column(first, use_in(curves.tables[0].columns));
    for_each_column(second, use_in(curves.tables[1].columns));
    for_each_difference(first, second, use_in(curves.difference));
  }
}

}  // namespace

Values values_of(const ResultTable& table, const std::string& channel_name) {
  const std::size_t column = table.find(channel_name);
  Values values;
  values.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) values.push_back(table.at(row, column));
  return values;
}

const Values* find(const Columns& columns, const std::string& name) {
  for (const auto& [key, values] : columns)
    if (key == name) return &values;
  return nullptr;
}

Curves curves_of(const ResultTable& only) {
  Curves curves{only.theta_deg, {{only.name, {}}}, {}, {}};
  for_each_column(only, [&](const std::string& name, Values values) {
    curves.tables.front().columns.emplace_back(name, std::move(values));
  });
  return curves;
}

Curves curves_of(const ResultTable& first, const ResultTable& second) {
  return curves_of({{first, second}}, Rows::all);
}

Curves curves_of(const std::vector<TablePair>& pairs, Rows which) {
  const auto& [first, second] = pairs.front();
  Curves curves{first.theta_deg, {{first.name, {}}, {second.name, {}}}, {}, {}};
  if (which == Rows::shown && first.rows() > kMostRows) {
    RowsShown shown(first.rows(), kMostRows);
    for_each_curve(pairs, curves,
                   [&](Columns&, const std::string&, const Values& values) { shown.add(values); });
    curves.samples = first.rows();
    curves.rows = shown.rows();
    curves.theta_deg = some_of(curves.theta_deg, curves.rows);
  }
  for_each_curve(pairs, curves, [&](Columns& columns, const std::string& name, Values values) {
    columns.emplace_back(name,
                         curves.rows.empty() ? std::move(values) : some_of(values, curves.rows));
  });
  return curves;
}

}  // namespace bentaxis::report

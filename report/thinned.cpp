#include "thinned.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace bentaxis::report {
namespace {

using Columns = std::vector<std::pair<std::string, Values>>;

void add_extremes(const Columns& columns, std::set<std::size_t>& rows) {
  for (const auto& [name, values] : columns) {
    std::size_t least = values.size(), most = values.size();
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!std::isfinite(values[row])) continue;
      if (least == values.size() || values[row] < values[least]) least = row;
      if (most == values.size() || values[row] > values[most]) most = row;
    }
    if (least == values.size()) continue;
    rows.insert(least);
    rows.insert(most);
  }
}

// Only of what has a value at every row.
void keep(Values& values, std::size_t all, const std::vector<std::size_t>& rows) {
  if (values.size() != all) return;
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = values[rows[i]];
  values.resize(rows.size());
}

void keep(Columns& columns, std::size_t all, const std::vector<std::size_t>& rows) {
  for (auto& [name, values] : columns) keep(values, all, rows);
}

}  // namespace

std::vector<std::size_t> rows_shown(const Curves& curves, std::size_t most) {
  const std::size_t all = curves.theta_deg.size();
  std::set<std::size_t> rows;
  const std::size_t even = std::min(all, most);
  for (std::size_t i = 0; i < even; ++i) rows.insert(even == 1 ? 0 : i * (all - 1) / (even - 1));
  if (even < all) {
    for (const Curves::Table& table : curves.tables) add_extremes(table.columns, rows);
    add_extremes(curves.difference, rows);
  }
  return {rows.begin(), rows.end()};
}

Thinned thinned(const Document& document, const Curves& curves,
                const std::vector<std::size_t>& rows) {
  const std::size_t all = curves.theta_deg.size();
  Thinned result{document, curves};
  Curves& of_page = result.curves;
  of_page.samples = all;
  keep(of_page.theta_deg, all, rows);
  for (Curves::Table& table : of_page.tables) keep(table.columns, all, rows);
  keep(of_page.difference, all, rows);
  if (of_page.reference)
    for (Curves::Held& held : of_page.reference->held) {
      keep(held.values, all, rows);
      keep(held.low, all, rows);
      keep(held.high, all, rows);
      keep(held.differences, all, rows);
    }
  if (result.document.figures)
    for (Figure& figure : *result.document.figures)
      if (auto* const channels = std::get_if<ChannelFigure>(&figure.content);
          channels != nullptr && !channels->curves)
        for (Series& series : channels->extra) keep(series.values, all, rows);
  if (result.document.scene && !result.document.scene->curves) {
    Scene& scene = *result.document.scene;
    for (Values& series : scene.series) keep(series, all, rows);
    scene.rows = rows.size();
  }
  return result;
}

}  // namespace bentaxis::report

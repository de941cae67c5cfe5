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

// Some rows of what has a value at every row; all of anything else.
class Kept {
 public:
  Kept(std::size_t all, const std::vector<std::size_t>& rows) : all_(all), rows_(rows) {}

  Values operator()(const Values& values) const {
    if (values.size() != all_) return values;
    Values some;
    some.reserve(rows_.size());
    for (const std::size_t row : rows_) some.push_back(values[row]);
    return some;
  }
  Columns operator()(const Columns& columns) const {
    Columns some;
    for (const auto& [name, values] : columns) some.emplace_back(name, (*this)(values));
    return some;
  }
  Curves::Reference operator()(const Curves::Reference& reference) const {
    Curves::Reference some{reference.name, {}};
    for (const Curves::Held& held : reference.held)
      some.held.push_back({held.channel, (*this)(held.values), held.allowed, (*this)(held.low),
                           (*this)(held.high), (*this)(held.differences)});
    return some;
  }
  // Without a copy of all rows, which may be most of the memory.
  Curves operator()(const Curves& curves) const {
    Curves some;
    some.theta_deg = (*this)(curves.theta_deg);
    for (const Curves::Table& table : curves.tables)
      some.tables.push_back({table.name, (*this)(table.columns)});
    some.difference = (*this)(curves.difference);
    if (curves.reference) some.reference = (*this)(*curves.reference);
    some.axis = curves.axis;
    some.marks = curves.marks;
    some.samples = all_;
    return some;
  }

 private:
  std::size_t all_;
  const std::vector<std::size_t>& rows_;
};

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
  const Kept kept(curves.theta_deg.size(), rows);
  Thinned result{document, kept(curves)};
  if (result.document.figures)
    for (Figure& figure : *result.document.figures)
      if (auto* const channels = std::get_if<ChannelFigure>(&figure.content);
          channels != nullptr && !channels->curves)
        for (Series& series : channels->extra) series.values = kept(series.values);
  if (result.document.scene && !result.document.scene->curves) {
    Scene& scene = *result.document.scene;
    for (Values& series : scene.series) series = kept(series);
    scene.rows = rows.size();
  }
  return result;
}

}  // namespace bentaxis::report

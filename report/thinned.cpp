#include "thinned.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace bentaxis::report {
namespace {

using Columns = std::vector<std::pair<std::string, Values>>;

// Some rows of what has a value at every row; all of anything else.
class Kept {
 public:
  Kept(std::size_t all, const std::vector<std::size_t>& rows) : all_(all), rows_(rows) {}

  Values operator()(const Values& values) const {
    return values.size() == all_ ? some_of(values, rows_) : values;
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
    some.rows = rows_;
    return some;
  }

 private:
  std::size_t all_;
  const std::vector<std::size_t>& rows_;
};

}  // namespace

RowsShown::RowsShown(std::size_t all, std::size_t most) {
  const std::size_t even = std::min(all, most);
  for (std::size_t i = 0; i < even; ++i) rows_.insert(even == 1 ? 0 : i * (all - 1) / (even - 1));
}

void RowsShown::add(const Values& curve) {
  std::size_t least = curve.size(), most = curve.size();
  for (std::size_t row = 0; row < curve.size(); ++row) {
    if (!std::isfinite(curve[row])) continue;
    if (least == curve.size() || curve[row] < curve[least]) least = row;
    if (most == curve.size() || curve[row] > curve[most]) most = row;
  }
  if (least == curve.size()) return;
  rows_.insert(least);
  rows_.insert(most);
}

std::vector<std::size_t> rows_shown(const Curves& curves, std::size_t most) {
  const std::size_t all = curves.theta_deg.size();
  RowsShown shown(all, most);
  if (all > most) {
    for (const Curves::Table& table : curves.tables)
      for (const auto& [name, values] : table.columns) shown.add(values);
    for (const auto& [name, values] : curves.difference) shown.add(values);
  }
  return shown.rows();
}

Values some_of(const Values& values, const std::vector<std::size_t>& rows) {
  Values some;
  some.reserve(rows.size());
  for (const std::size_t row : rows) some.push_back(values[row]);
  return some;
}

Curves thinned(const Curves& curves, const std::vector<std::size_t>& rows) {
  return Kept(curves.theta_deg.size(), rows)(curves);
}

Document thinned(const Document& document, std::size_t all, const std::vector<std::size_t>& rows) {
  const Kept kept(all, rows);
  Document result = document;
  if (result.figures)
    for (Figure& figure : *result.figures)
      if (auto* const channels = std::get_if<ChannelFigure>(&figure.content);
          channels != nullptr && !channels->curves)
        for (Series& series : channels->extra) series.values = kept(series.values);
  if (result.scene && !result.scene->curves) {
    Scene& scene = *result.scene;
    for (Values& series : scene.series) series = kept(series);
    scene.rows = rows.size();
  }
  return result;
}

}  // namespace bentaxis::report

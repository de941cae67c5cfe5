// What one column of a table holds.
#pragma once

#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis {

/// The values of a column, row by row.
inline std::vector<double> column_of(const ResultTable& table, std::size_t column) {
  std::vector<double> values(table.rows());
  for (std::size_t row = 0; row < values.size(); ++row) values[row] = table.at(row, column);
  return values;
}

/// Whether a table has a column and that a value in any row.
inline bool any_computed(const ResultTable& table, std::size_t column) {
  for (std::size_t row = 0; column < table.columns() && row < table.rows(); ++row)
    if (is_computed(table.at(row, column))) return true;
  return false;
}

}  // namespace bentaxis

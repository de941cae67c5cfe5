// A table of results as Python sees it: columns by name over memory of the computation.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/results/motion.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::python {

/// One column, in memory that the table keeps.
struct Column {
  std::string name, unit, meaning;
  const double* first = nullptr;
  std::size_t stride = 1;               ///< numbers from row to row
  std::optional<Channel> channel = {};  ///< what is known of a result
};

struct Table {
  std::string name;
  std::size_t rows = 0;
  std::vector<Column> columns;
  bool first_is_index = true;      ///< the first column says where a row is: angle or time
  std::size_t first_of_block = 0;  ///< columns from here on lie in one block of memory
  std::function<std::string()> csv;
  std::shared_ptr<const void> owner;
  std::vector<std::string> warnings = {};  ///< warnings about the case or the results

  /// @throws pybind11::key_error
  const Column& column(const std::string& wanted) const;
  /// Whether column() finds one.
  bool has(const std::string& wanted) const;
};

Table table_of(std::shared_ptr<const ResultTable> of);
Table table_of(std::shared_ptr<const MotionTable> of);
/// What the oil of a simulation does.
Table oil_table_of(std::shared_ptr<const Trajectory> of, const std::string& name);

/// A table with memory of its own, of numbers row by row: what a pickle becomes.
Table table_of(std::string name, std::vector<Column> columns, std::vector<double> numbers,
               std::size_t rows, bool first_is_index, std::size_t first_of_block);

/// A part of what `whole` keeps.
template <class Part, class Whole>
std::shared_ptr<const Part> part_of(const std::shared_ptr<Whole>& whole, const Part& part) {
  return {whole, &part};
}

}  // namespace bentaxis::python

// A sheet of cells before it is known which of them are names, units and numbers.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bentaxis/files/foreign_table.h"

namespace bentaxis::foreign {

struct Cell {
  std::string_view text;
  double value = 0;
  int digits = 0;       ///< significant ones, of a number
  bool number = false;  ///< else text; empty text = no value
};

struct Row {
  unsigned line = 0;  ///< of the file or sheet, from 1
  std::vector<Cell> cells;
};

struct Grid {
  std::vector<Row> rows;
  std::deque<std::string> storage;  ///< of the cells' texts
  bool blanks = false;              ///< fields are parted by blanks: names may hold some
  bool fixed_width = false;         ///< every row has a field for each column
  /// Where a cell is, for a message.
  std::function<std::string(const Row& row, std::size_t column)> place;
};

/// Names, units and numbers of a grid.
/// @throws InputError naming the cell that should be a number
void fill(const Grid& grid, ForeignTable& table);

/// Whether the whole of a text is a finite number; its value and number of significant digits.
bool parse_number(std::string_view text, char decimal, double& value, int& digits);

std::string_view trimmed(std::string_view text);

ForeignTable read_text(const std::filesystem::path& file, std::string content);
ForeignTable read_workbook(const std::filesystem::path& file, const std::string& sheet);
ForeignTable read_matlab(const std::filesystem::path& file, const std::string& wanted);

}  // namespace bentaxis::foreign

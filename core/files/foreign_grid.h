// A sheet of cells before it is known which of them are names, units and numbers.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bentaxis/files/foreign_table.h"
#include "bentaxis/pump/text.h"

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

/// Whether a grid is a line of names and lines of as many numbers, and nothing else: a table even
/// with a single line of numbers.
bool is_plain_table(const Grid& grid);

/// Names, units and numbers of a grid.
/// @throws InputError naming the cell that should be a number
void fill(const Grid& grid, ForeignTable& table);

/// Whether the whole of a text is a finite number; its value and number of significant digits.
bool parse_number(std::string_view text, char decimal, double& value, int& digits);

/// Without the blanks at both ends of a cell; the ends of its lines stay.
inline std::string_view trimmed(std::string_view text) { return bentaxis::trimmed(text, " \t\r"); }

/// Makes names differ from those before them: "F", "F (2)", "F (3)".
class DifferentNames {
 public:
  DifferentNames() = default;
  explicit DifferentNames(const std::vector<std::string>& taken)
      : taken_(taken.begin(), taken.end()) {}
  std::string different(const std::string& name) {
    if (taken_.insert(name).second) return name;
    for (int& again = next_.emplace(name, 2).first->second;; ++again)
      if (std::string other = name + " (" + std::to_string(again) + ")";
          taken_.insert(other).second)
        return other;
  }

 private:
  std::set<std::string> taken_;
  std::map<std::string, int> next_;
};

ForeignTable read_text(const std::filesystem::path& file, std::string content);
ForeignTable read_workbook(const std::filesystem::path& file, const std::string& content,
                           const std::string& sheet);
ForeignTable read_matlab(const std::filesystem::path& file, const std::string& content,
                         const std::string& wanted);
/// That a MATLAB file is as long as its own structure says, with every element inside the one that
/// holds it: versions 4, 5 to 7.2 and 7.3, of which HDF5's own end is looked at.
/// @throws InputError naming file, byte and what is missing
void check_matlab_structure(const std::filesystem::path& file, const std::string& content);

/// A table has at most this many columns, and a sheet or text this many cells.
inline constexpr std::size_t kMaxColumns = 20000;
inline constexpr std::size_t kMaxCells = 20'000'000;

}  // namespace bentaxis::foreign

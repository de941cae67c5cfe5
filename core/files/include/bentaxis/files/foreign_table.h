// Tables of numbers as other programs write them: text with any separator, ADAMS tables and request
// files, Excel workbooks, MATLAB files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/files/csv.h"

namespace bentaxis {

/// Columns of numbers with names. Empty fields are not_computed().
struct ForeignTable : NumericTable {
  std::filesystem::path file;
  std::string sheet;               ///< of a workbook, or the variable of a MATLAB file
  std::vector<std::string> units;  ///< as written in the names or in a line of units; "" = none
  /// Significant digits that each column is written in; 0 where its few values do not show it.
  std::vector<int> digits;
  std::string format;  ///< in words: "text, separated by semicolons, decimal comma"

  /// Where a row stands, for a message: "file:12", "file, sheet S, row 12".
  std::string place(std::size_t row) const;
};

/// Reads a table. The format is told by the file's content.
/// - Text: comma, semicolon, tab or blanks between the fields; decimal point or comma; lines of
///   titles before, a line of names (quoted or not) and a line of units; byte-order mark, UTF-16;
///   several tables below each other over the same first column are put side by side.
/// - ADAMS: exported tables, request files (a line with the time, then a line per request).
/// - Excel (.xlsx): the values of a sheet.
/// - MATLAB (.mat, versions 4 to 7.3): vectors and columns of matrices of the same length, in
///   structures too; names from a cell array of as many texts.
/// @param sheet  name of the sheet or variable to take; "" = the first with a table
/// @throws InputError naming file, line or cell, and its content
ForeignTable read_table(const std::filesystem::path& file, const std::string& sheet = "");
/// The same of a content that was read from `file`.
ForeignTable table_of(const std::string& content, const std::filesystem::path& file,
                      const std::string& sheet = "");

/// The unit that a column's name ends with or has in brackets, as written; "" = none.
std::string unit_in_name(const std::string& name);

/// A unit as written by people and programs, in the spelling of this program: "newton-mm" -> "Nmm",
/// "sec" -> "s". "" where it is none.
/// Known: N kN MN daN kgf lbf; Nm kNm Nmm lbf in, lbf ft; m mm cm um in; Pa kPa MPa bar mbar psi;
/// deg rad mrad turn gon; s ms us min; rpm deg/s rad/s.
std::string known_unit(const std::string& text);

}  // namespace bentaxis

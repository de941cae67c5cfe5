// Reading and writing numbers in CSV files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bentaxis {

/// A CSV file of numbers with one header line. Empty fields are not_computed().
struct NumericTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;
  std::vector<unsigned> lines;  ///< of the file, one per row
};

/// Reads a file of numbers, comma separated, one header line. Numbers are converted exactly
/// (std::from_chars); text, NaN and infinities are refused.
/// @param allow_empty  an empty field is "not computed" rather than an error
/// @throws InputError naming file, line, column and text.
NumericTable read_numeric_csv(const std::filesystem::path& file, bool allow_empty = false);

/// Appends the shortest text that reads back to the same double; nothing where not computed.
void append_number(std::string& text, double value);

/// The same as a string of its own.
std::string number_text(double value);

}  // namespace bentaxis

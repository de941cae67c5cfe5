// Tables of numbers in CSV files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/result_table.h"

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

/// Reads the curve of a chamber pressure from any table of foreign_table.h: one column of angles
/// (deg, rad, turn, gon) and one of gauge pressures (bar, mbar, Pa, kPa, MPa, psi), with units in
/// their headings. The first point may come again a turn later, with the same pressure.
/// @throws InputError naming file and line.
PressureCurve read_pressure_curve(const std::filesystem::path& file);

/// Reads the opening of a port: CSV with the header theta_deg,area_mm2, over the chamber's angle.
/// @throws InputError naming file and line.
OpeningTable read_opening_table(const std::filesystem::path& file);

/// The table as CSV text: theta_deg, then one column per channel; shortest text that reads back to
/// the same double; not computed = empty.
std::string to_csv(const ResultTable& table);

/// Its parts: the header line, and one line of numbers.
std::string csv_header(const std::vector<Channel>& channels);
void append_csv_row(std::string& text, double theta_deg, const double* values, std::size_t count);

}  // namespace bentaxis

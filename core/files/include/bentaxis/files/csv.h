// Tables of numbers in CSV files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/drive_spec.h"
#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis {

/// A CSV file of numbers with one header line. Empty fields are not_computed().
struct NumericTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;
  std::vector<unsigned> lines;  ///< of the file, one per row
};

/// Reads a file of numbers, comma separated, one header line. Numbers are converted exactly
/// (std::from_chars); text, NaN and infinities are refused. A file whose first line is separated by
/// semicolons, tabs or blanks, and a workbook or MATLAB file, is read by foreign_table.h.
/// @param allow_empty  an empty field is "not computed" rather than an error
/// @throws InputError naming file, line, column and text.
NumericTable read_numeric_csv(const std::filesystem::path& file, bool allow_empty = false);
/// The same of a content that was read from `file`.
NumericTable numeric_csv_of(const std::string& content, const std::filesystem::path& file,
                            bool allow_empty);

/// A text as one field: quoted where it has a comma, a quotation mark or a line break.
std::string csv_text(const std::string& text);

/// Reads the curve of a chamber pressure from any table of foreign_table.h: one column of angles
/// (deg, rad, turn, gon) and one of gauge pressures (bar, mbar, Pa, kPa, MPa, psi), with units in
/// their headings. The first point may come again a turn later, with the same pressure.
/// @throws InputError naming file and line.
PressureCurve read_pressure_curve(const std::filesystem::path& file);

/// Reads the opening of a port: CSV with the header theta_deg,area_mm2, over the chamber's angle.
/// @throws InputError naming file and line.
OpeningTable read_opening_table(const std::filesystem::path& file);

/// Reads the stroke of a piston: CSV with the header theta_deg,stroke_mm or theta_deg,volume_cm3,
/// over the chamber's angle.
/// @throws InputError naming file and line.
StrokeTable read_stroke_table(const std::filesystem::path& file);

/// Reads what drives a shaft: a table (foreign_table.h) with one column each of time and speed or
/// torque, of a motor of speed and torque, with their units: time_s,torque_Nm or time [ms],M [kNm].
/// @throws InputError naming file and line.
TimeCurve read_drive_curve(const std::filesystem::path& file, DriveKind kind);

/// Reads the share of a load over time: a table with a column of time and share; shares >= 0.
/// @throws InputError naming file and line.
TimeCurve read_share_curve(const std::filesystem::path& file);

/// Reads the pitch errors of shaft and block: CSV with the header tooth,shaft_um,block_um, a row
/// for each of the `count` teeth.
/// @throws InputError naming file and line.
void read_tooth_errors(const std::filesystem::path& file, ToothData& teeth);

/// Reads by how much the clearance of each piston differs from that of all: CSV with the header
/// piston,deviation_um, a row for each piston in any order.
/// @return  m, of pistons 1, 2, .. N
/// @throws InputError naming file, line and value.
std::vector<double> read_clearance_deviations(const std::filesystem::path& file, int pistons);

/// Reads the motion of another simulator or a rig: CSV with theta_deg, psi_deg, theta_rpm, psi_rpm,
/// theta_rad_per_s2, psi_rad_per_s2 and where there are any time_s, p_1_bar .. p_N_bar,
/// suction_bar, delivery_bar, in any order. Pressures that it does not give are the case's, those
/// of the chambers at the block's angle.
/// @throws InputError naming file, line, column and value.
States read_states(const std::filesystem::path& file, const Case& the_case,
                   const PressureTrace& pressure);

/// The same from a table that is there already.
/// @param file  what messages call it, with the table's lines
/// @param head  what messages call its line of names: "file:1"
/// @throws InputError as above
States states_of(const NumericTable& table, const std::filesystem::path& file,
                 const std::string& head, const Case& the_case, const PressureTrace& pressure);

/// Where a long text goes, piece by piece.
using TextSink = std::function<void(const std::string& piece)>;

/// A table along a motion as CSV text: its states, then its channels.
std::string to_csv(const MotionTable& table);
void write_csv(const MotionTable& table, const TextSink& write);

/// What the oil of a simulation does: time_s, then its columns.
std::string oil_csv(const Trajectory& run);
void write_oil_csv(const Trajectory& run, const TextSink& write);

/// The table as CSV text: theta_deg, then one column per channel; shortest text that reads back to
/// the same double; not computed = empty.
std::string to_csv(const ResultTable& table);
/// @param wanted  which of its channels; empty: all
void write_csv(const ResultTable& table, const TextSink& write,
               const std::function<bool(const Channel&)>& wanted = {});

/// Its parts: the header line, and one line of numbers.
std::string csv_header(const std::vector<Channel>& channels);
void append_csv_row(std::string& text, double theta_deg, const double* values, std::size_t count);

}  // namespace bentaxis

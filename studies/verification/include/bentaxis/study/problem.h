// The problem set (docs/problems.md): mechanisms with known reactions, and how far a table of
// anyone's results is from them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/files/foreign_table.h"

namespace bentaxis::study {

/// A column that a problem asks for. Values and peak are in the unit of its name.
struct ProblemColumn {
  std::string name;    ///< "Rb1_x1_N"
  std::string vector;  ///< what it is a component of; the peak is that of the whole vector
  std::string meaning, on, by, at, frame;
  double peak = 0;
  int digits = 0;     ///< to which two derivations agree
  double spread = 0;  ///< from inputs changed by 2 ulp, share of the peak
  std::vector<double> values;
};

/// A mistake that others make, with what it makes of the columns.
struct KnownMistake {
  std::string key, says;
  std::map<std::size_t, std::vector<double>> curves;  ///< by column, at Problem::mistake_rows
};

/// A problem as its folder has it.
struct Problem {
  std::string name, title;
  std::filesystem::path folder;
  std::string over;          ///< column that the curves stand over: "theta_deg"
  double period = 0;         ///< of it; 0: none
  bool smooth = true;        ///< values between the rows can be interpolated
  double tolerance = 0;      ///< share of the peak
  std::vector<double> grid;  ///< equally spaced
  std::vector<ProblemColumn> columns;
  std::vector<KnownMistake> mistakes;
  std::vector<std::size_t> mistake_rows;  ///< of the grid
};

/// Reads the folder of a problem. @throws InputError naming file, line and key or column
Problem read_problem(const std::filesystem::path& folder);
/// Names of the problems of a folder, by the alphabet.
std::vector<std::string> problem_names(const std::filesystem::path& folder);

/// A curve that is wrong is given a name only where the known mistake's curve is within this share
/// of the peak,
inline constexpr double kNamedWithin = 1e-3;
/// at least so many times nearer than the right curve,
inline constexpr double kNamedNearer = 10;
/// and compared at so many rows.
inline constexpr std::size_t kNamedRows = 12;

/// How far one column of a table is from what is right.
struct ColumnScore {
  enum class State { agrees, differs, missing } state = State::missing;
  std::size_t column = 0;        ///< of the problem
  std::size_t rows = 0;          ///< compared
  double largest = 0;            ///< difference beyond the error of interpolation, column's unit
  double at = 0;                 ///< where it is largest
  double theirs = 0, right = 0;  ///< there
  double interpolation = 0;      ///< largest error of interpolation, share of the peak
  double digits = 0;             ///< -log10 of the largest difference over the peak, 0 to 16
};

/// What wrong columns look like.
struct NamedMistake {
  std::string says;
  std::vector<std::size_t> columns;    ///< that it explains
  double distance = 0;                 ///< of their curves from it, share of the peak
  std::vector<std::string> or_else;    ///< others that explain the same
  std::vector<std::size_t> untouched;  ///< columns that it should change, and that are right
};

/// How far a table is from a problem's curves.
struct Score {
  enum class Verdict { solved, incomplete, wrong } verdict = Verdict::incomplete;
  double tolerance = 0;
  std::vector<ColumnScore> columns;  ///< of all columns that are asked for
  std::vector<NamedMistake> mistakes;
  std::vector<std::size_t> unexplained;  ///< columns that are wrong in no known way
  std::vector<std::string> gaps;         ///< what is missing, assumed or left out, in sentences
  std::size_t covered = 0;               ///< angles of the problem at which the table has a row
  /// Of the columns that were compared, the fewest.
  double digits() const;
};

/// Scores a table. Units in the names of its columns are converted; rows at other angles than the
/// problem's are compared with interpolated curves, with the error of the interpolation allowed.
/// @param tolerance  share of the peak; the problem's where it is not given
/// @throws InputError where the table has no angles or none of the columns
Score score(const Problem& problem, const ForeignTable& table, std::optional<double> tolerance);

}  // namespace bentaxis::study

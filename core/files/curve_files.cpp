// Curves in files: pressure over the turn, openings, strokes, what drives and loads over time,
// errors of teeth, clearances.
#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/input_limits.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"
#include "refused_value.h"

namespace bentaxis {
namespace {

// Column of a foreign table that is an angle or a pressure, with the size of its unit (degrees,
// Pa); by unit, else by name.
struct PressureColumn {
  std::size_t index;
  double unit;
};

PressureColumn find_column(const ForeignTable& table, const std::map<std::string, double>& units,
                           const std::vector<std::string>& names, const std::string& what) {
  std::vector<PressureColumn> found;
  for (const bool by_name : {false, true}) {
    if (!found.empty()) break;
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      const std::string unit = known_unit(table.units[c]);
      const std::string name = lower_case(table.header[c]);
      if (const auto it = units.find(unit); it != units.end()) {
        found.push_back({c, it->second});
      } else if (by_name && std::any_of(names.begin(), names.end(), [&](const auto& word) {
                   return name.find(word) != std::string::npos;
                 })) {
        throw InputError(table.file.string() + ": column \"" + table.header[c] +
                         "\" has no unit of " + what + ": name one in its heading, as in [" +
                         units.begin()->first + "]");
      }
    }
  }
  if (found.size() == 1) return found.front();
  throw InputError(table.file.string() + ": must have one column of " + what +
                   " with its unit; its columns are " + joined(table.header));
}

}  // namespace

PressureCurve read_pressure_curve(const std::filesystem::path& file) {
  // A file with our own heading is held to it line by line.
  ForeignTable table;
  const std::string content = read_input_file(file, {"a pressure curve", kLargestTable});
  const auto heading = std::string_view(content).substr(0, content.find('\n'));
  if (trimmed(heading) == "theta_deg,pressure_bar") {
    static_cast<NumericTable&>(table) = numeric_csv_of(content, file, false);
    table.file = file;
    table.units = {"deg", "bar"};
  } else {
    table = table_of(content, file);
  }
  const auto angle =
      find_column(table, {{"deg", 1}, {"rad", 1 / kRadPerDegree}, {"turn", 360}, {"gon", 0.9}},
                  {"theta", "angle", "phi", "winkel"}, "angle");
  const auto pressure = find_column(table,
                                    {{"bar", pascals(1)},
                                     {"mbar", 1e2},
                                     {"Pa", 1},
                                     {"kPa", 1e3},
                                     {"MPa", 1e6},
                                     {"psi", 6894.757293168361}},
                                    {"press", "druck"}, "pressure");
  PressureCurve curve;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double theta = table.rows[i][angle.index] * angle.unit;
    const double value = table.rows[i][pressure.index];
    const auto refuse = [&](const std::string& range) {
      throw InputError(table.place(i) + ": " + table.header[angle.index] + " = " +
                       number_text(table.rows[i][angle.index]) + ": must be " + range);
    };
    if (!is_computed(theta) || !is_computed(value))
      throw InputError(table.place(i) + ": " +
                       table.header[is_computed(theta) ? pressure.index : angle.index] +
                       " = \"\": must be a finite number");
    if (i > 0 && !(theta > curve.theta_deg.back()))
      refuse("> " + number_text(curve.theta_deg.back()) + " deg (angles increase strictly)");
    const double pascal =
        known_unit(table.units[pressure.index]) == "bar" ? pascals(value) : value * pressure.unit;
    if (!kPressureRange.contains(pascal / kPascalPerBar))
      throw InputError(table.place(i) + ": " + table.header[pressure.index] + " = " +
                       number_text(value) + ": must be " + kPressureRange.text() + " bar");
    constexpr double kSameAngle = 1e-9;
    if (i > 0 && i + 1 == table.rows.size() &&
        std::abs(theta - curve.theta_deg.front() - 360) < kSameAngle) {
      // The end point may come again.
      if (pascal != curve.pressure.front())
        throw InputError(table.place(i) + ": " + table.header[pressure.index] + " = " +
                         number_text(value) +
                         ": must equal the value at the start of the turn: the curve is periodic");
      break;
    }
    if (i > 0 && !(theta - curve.theta_deg.front() < 360))
      refuse("< " + number_text(curve.theta_deg.front() + 360) + " deg (a turn after the first)");
    curve.theta_deg.push_back(theta);
    curve.pressure.push_back(pascal);
  }
  return curve;
}

namespace {

// A file of numbers under a fixed heading.
class CurveFile {
 public:
  /// @param headings  of which it must have one
  CurveFile(const std::filesystem::path& file, const std::vector<std::string>& headings)
      : file_(file), table_(read_numeric_csv(file)) {
    const auto is_its_own = [&](const std::string& heading) {
      const auto commas = std::count(heading.begin(), heading.end(), ',');
      return table_.header.size() == static_cast<std::size_t>(commas) + 1 &&
             joined(table_.header, ",") == heading;
    };
    if (std::none_of(headings.begin(), headings.end(), is_its_own))
      throw InputError(file.string() + ":1: header must be " + joined(headings, " or "));
    for (std::size_t row = 0; row < rows(); ++row)
      for (std::size_t c = 0; c < table_.rows[row].size(); ++c)
        if (std::abs(at(row, c)) > kLargestInput)
          refuse(row, c, "of a magnitude up to " + number_text(kLargestInput));
  }

  std::size_t rows() const { return table_.rows.size(); }
  double at(std::size_t row, std::size_t column) const { return table_.rows[row][column]; }
  const std::string& name(std::size_t column) const { return table_.header[column]; }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(file_.string() + ": " + why);
  }
  [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& range) const {
    refuse_value(file_, table_, row, column, range);
  }
  void require_points(std::size_t fewest) const {
    if (rows() < fewest)
      refuse("has " + counted(rows(), "point") + ", must be at least " + std::to_string(fewest));
  }
  void require_count(int count, const std::string& one, const std::string& more,
                     const std::string& key) const {
    if (rows() != static_cast<std::size_t>(count))
      refuse("has " + counted(rows(), one, more) + ", must be " + key + " = " +
             std::to_string(count));
  }

  /// The angle of a row over the turn, after those before it.
  double next_angle(std::size_t row) const {
    const double theta = at(row, 0);
    if (row == 0) return theta;
    if (!(theta > at(row - 1, 0)))
      refuse(row, 0, "> " + number_text(at(row - 1, 0)) + " (angles increase strictly)");
    if (!(theta - at(0, 0) < 360))
      refuse(row, 0,
             "< " + number_text(at(0, 0) + 360) +
                 " (a turn after the first; the end point is not repeated)");
    return theta;
  }

 private:
  const std::filesystem::path& file_;
  NumericTable table_;
};

}  // namespace

OpeningTable read_opening_table(const std::filesystem::path& file) {
  const CurveFile table(file, {"theta_deg,area_mm2"});
  OpeningTable opening{file, {}, {}};
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double theta = table.next_angle(i);
    if (!(table.at(i, 1) >= 0)) table.refuse(i, 1, ">= 0");
    opening.theta_deg.push_back(theta);
    opening.area.push_back(square_metres(table.at(i, 1)));
  }
  table.require_points(3);
  if (*std::max_element(opening.area.begin(), opening.area.end()) == 0)
    table.refuse("area_mm2 is 0 at every angle: must be > 0 somewhere");
  return opening;
}

StrokeTable read_stroke_table(const std::filesystem::path& file) {
  const CurveFile table(file, {"theta_deg,stroke_mm", "theta_deg,volume_cm3"});
  StrokeTable stroke{file, {}, {}, table.name(1) == "volume_cm3"};
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double theta = table.next_angle(i), value = table.at(i, 1);
    if (stroke.is_volume && !(value > 0)) table.refuse(i, 1, "> 0");
    stroke.theta_deg.push_back(theta);
    stroke.value.push_back(stroke.is_volume ? value / 1e6 : metres(value));
  }
  table.require_points(4);
  const auto [least, greatest] = std::minmax_element(stroke.value.begin(), stroke.value.end());
  if (*least == *greatest)
    table.refuse(table.name(1) + " is the same at every angle: the pistons have no stroke");
  return stroke;
}

namespace {

// Of a value over `first`, times or speeds, as the file has it.
TimeCurve read_time_curve(const std::filesystem::path& file, const std::string& first,
                          const std::string& second, bool negative) {
  const CurveFile table(file, {first + "," + second});
  const bool in_time = first == "time_s";
  TimeCurve curve{file, {}, {}};
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double at = table.at(i, 0);
    if (i == 0 && at > 0 && in_time) table.refuse(i, 0, "<= 0 (a simulation starts at 0)");
    if (i > 0 && !(at > curve.time.back()))
      table.refuse(i, 0,
                   "> " + number_text(curve.time.back()) + ", the one before it (" +
                       (in_time ? "times" : "speeds") + " increase strictly)");
    if (!negative && !(table.at(i, 1) >= 0)) table.refuse(i, 1, ">= 0");
    curve.time.push_back(at);
    curve.value.push_back(table.at(i, 1));
  }
  if (table.rows() < 4)
    table.refuse("points: " + std::to_string(table.rows()) + ", must be at least 4");
  return curve;
}

}  // namespace

TimeCurve read_drive_curve(const std::filesystem::path& file, DriveKind kind) {
  const bool motor = kind == DriveKind::motor;
  const bool speed = kind == DriveKind::speed;
  TimeCurve curve = read_time_curve(file, motor ? "speed_rpm" : "time_s",
                                    speed ? "speed_rpm" : "torque_Nm", true);
  for (double& value : motor ? curve.time : curve.value)
    if (motor || speed) value = rad_per_second(value);
  return curve;
}

TimeCurve read_share_curve(const std::filesystem::path& file) {
  return read_time_curve(file, "time_s", "share", false);
}

void read_tooth_errors(const std::filesystem::path& file, ToothData& teeth) {
  const CurveFile table(file, {"tooth,shaft_um,block_um"});
  table.require_count(teeth.count, "tooth", "teeth", "tooth_number");
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (table.at(i, 0) != static_cast<double>(i + 1))
      table.refuse(i, 0, std::to_string(i + 1) + " (teeth in their order)");
    teeth.shaft.pitch.push_back(table.at(i, 1) / 1e6);
    teeth.block.pitch.push_back(table.at(i, 2) / 1e6);
  }
}

std::vector<double> read_clearance_deviations(const std::filesystem::path& file, int pistons) {
  const CurveFile table(file, {"piston,deviation_um"});
  table.require_count(pistons, "piston", "pistons", "[pump] pistons");
  std::vector<double> deviation(table.rows());
  std::vector<bool> given(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double number = table.at(i, 0);
    if (!(number >= 1 && number <= pistons) || number != std::floor(number))
      table.refuse(i, 0, "a whole number in [1, " + std::to_string(pistons) + "]");
    const auto piston = static_cast<std::size_t>(number) - 1;
    if (given[piston]) table.refuse(i, 0, "a piston that is not given before");
    given[piston] = true;
    deviation[piston] = table.at(i, 1) / 1e6;
  }
  return deviation;
}

}  // namespace bentaxis

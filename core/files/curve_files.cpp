// Curves in files: pressure over the turn, openings, strokes, what drives and loads over time,
// errors of teeth, clearances.
#include <algorithm>
#include <cmath>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/input_limits.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/units.h"
#include "refused_value.h"

namespace bentaxis {
namespace {

// A table of any format with its units, but one with our own heading is held to it line by line.
ForeignTable table_with_units(const std::filesystem::path& file, const char* what,
                              const std::vector<std::string>& own_heading,
                              const std::vector<std::string>& own_units) {
  const std::string content = read_input_file(file, {what, kLargestTable});
  const auto heading = std::string_view(content).substr(0, content.find('\n'));
  if (trimmed(heading) != joined(own_heading, ",")) return table_of(content, file);
  ForeignTable table;
  static_cast<NumericTable&>(table) = numeric_csv_of(content, file, false);
  table.file = file;
  table.units = own_units;
  return table;
}

// A quantity that a file has a column of, in words, with an example of its unit and how its name
// may begin where it lacks one.
struct WantedColumn {
  std::string quantity, words, unit;
  std::vector<std::string> names;
};

// A column with the size of its unit in SI.
struct QuantityColumn {
  const ForeignTable& table;
  std::size_t index;
  const UnitOfMeasure* unit;

  double at(std::size_t row) const { return table.rows[row][index]; }
  [[noreturn]] void refuse(std::size_t row, const std::string& range) const {
    throw InputError(table.place(row) + ": " + table.header[index] + " = " +
                     (is_computed(at(row)) ? number_text(at(row)) : "\"\"") + ": must be " + range);
  }
  void require_number(std::size_t row) const {
    if (!is_computed(at(row))) refuse(row, "a finite number");
    if (std::abs(at(row)) > kLargestInput)
      refuse(row, "of a magnitude up to " + number_text(kLargestInput));
  }
};

// By unit, else by name.
QuantityColumn find_column(const ForeignTable& table, const WantedColumn& wanted) {
  std::vector<QuantityColumn> found;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    if (const auto* const unit = find_unit_of_measure(known_unit(table.units[c]));
        unit != nullptr && unit->quantity == wanted.quantity)
      found.push_back({table, c, unit});
  if (found.size() == 1) return found.front();
  for (std::size_t c = 0; c < table.header.size() && found.empty(); ++c)
    for (const std::string& name : wanted.names)
      if (lower_case(table.header[c]).find(name) != std::string::npos)
        throw InputError(table.file.string() + ": column \"" + table.header[c] +
                         "\" has no unit of " + wanted.words +
                         ": name one in its heading, as in [" + wanted.unit + "]");
  throw InputError(table.file.string() + ": must have one column of " + wanted.words +
                   " with its unit, as in [" + wanted.unit + "]; its columns are " +
                   joined(table.header));
}

// A curve over angles that fall from row to row is the same curve in rising order.
template <class AnyTable>
AnyTable in_rising_order(AnyTable table, std::size_t angle) {
  const auto rises = [&](const auto& row, const auto& next) { return !(row[angle] > next[angle]); };
  if (table.rows.size() > 1 &&
      std::adjacent_find(table.rows.begin(), table.rows.end(), rises) == table.rows.end()) {
    std::reverse(table.rows.begin(), table.rows.end());
    std::reverse(table.lines.begin(), table.lines.end());
  }
  return table;
}

}  // namespace

PressureCurve read_pressure_curve(const std::filesystem::path& file) {
  static const WantedColumn kAngle = {"Angle", "angle", "deg", {"theta", "angle", "phi", "winkel"}};
  const ForeignTable given =
      table_with_units(file, "a pressure curve", {"theta_deg", "pressure_bar"}, {"deg", "bar"});
  const ForeignTable table = in_rising_order(given, find_column(given, kAngle).index);
  const auto angle = find_column(table, kAngle);
  const auto pressure = find_column(table, {"Pressure", "pressure", "bar", {"press", "druck"}});
  PressureCurve curve;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    angle.require_number(i);
    pressure.require_number(i);
    const double theta = angle.at(i) * (angle.unit->factor / kRadPerDegree);
    if (i > 0 && !(theta > curve.theta_deg.back()))
      angle.refuse(i,
                   "> " + number_text(curve.theta_deg.back()) + " deg (angles increase strictly)");
    const double pascal = pressure.unit->name == "bar" ? pascals(pressure.at(i))
                                                       : pressure.at(i) * pressure.unit->factor;
    if (!kPressureRange.contains(pascal / kPascalPerBar))
      pressure.refuse(i, kPressureRange.text() + " bar");
    constexpr double kSameAngle = 1e-9;
    if (i > 0 && i + 1 == table.rows.size() &&
        std::abs(theta - curve.theta_deg.front() - 360) < kSameAngle) {
      // The end point may come again.
      if (pascal != curve.pressure.front())
        pressure.refuse(i, "equal to the value at the start of the turn: the curve is periodic");
      break;
    }
    if (i > 0 && !(theta - curve.theta_deg.front() < 360))
      angle.refuse(
          i, "< " + number_text(curve.theta_deg.front() + 360) + " deg (a turn after the first)");
    curve.theta_deg.push_back(theta);
    curve.pressure.push_back(pascal);
  }
  return curve;
}

namespace {

// A file of numbers under a fixed heading.
class CurveFile {
 public:
  /// @param headings     of which it must have one
  /// @param over_angles  angles may fall from row to row
  CurveFile(const std::filesystem::path& file, const std::vector<std::string>& headings,
            bool over_angles = false)
      : file_(file),
        table_(over_angles ? in_rising_order(read_numeric_csv(file), 0) : read_numeric_csv(file)) {
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
  const CurveFile table(file, {"theta_deg,area_mm2"}, true);
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
  const CurveFile table(file, {"theta_deg,stroke_mm", "theta_deg,volume_cm3"}, true);
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

const WantedColumn kTimeColumn = {"Time", "time", "s", {"time", "zeit"}};
const WantedColumn kSpeedColumn = {"AngularVelocity", "speed", "rpm", {"speed", "drehzahl"}};
const WantedColumn kTorqueColumn = {"Torque", "torque", "Nm", {"torque", "moment"}};

// Of a value over times or speeds, in SI.
TimeCurve time_curve_of(const QuantityColumn& first, const QuantityColumn& second, bool negative) {
  const ForeignTable& table = first.table;
  const bool in_time = first.unit->quantity == kTimeColumn.quantity;
  TimeCurve curve{table.file, {}, {}};
  const auto in_si = [](const QuantityColumn& column, std::size_t row) {
    return column.unit->name == "rpm" ? rad_per_second(column.at(row))
                                      : column.at(row) * column.unit->factor;
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    first.require_number(i);
    second.require_number(i);
    if (i == 0 && first.at(i) > 0 && in_time) first.refuse(i, "<= 0 (a simulation starts at 0)");
    if (i > 0 && !(first.at(i) > first.at(i - 1)))
      first.refuse(i, "> " + number_text(first.at(i - 1)) + ", the one before it (" +
                          (in_time ? "times" : "speeds") + " increase strictly)");
    if (!negative && !(second.at(i) >= 0)) second.refuse(i, ">= 0");
    curve.time.push_back(in_si(first, i));
    curve.value.push_back(in_si(second, i));
  }
  constexpr std::size_t kFewestPoints = 4;
  if (curve.time.size() < kFewestPoints)
    throw InputError(table.file.string() + ": points: " + std::to_string(curve.time.size()) +
                     ", must be at least 4");
  return curve;
}

}  // namespace

TimeCurve read_drive_curve(const std::filesystem::path& file, DriveKind kind) {
  const WantedColumn& first = kind == DriveKind::motor ? kSpeedColumn : kTimeColumn;
  const WantedColumn& second = kind == DriveKind::speed ? kSpeedColumn : kTorqueColumn;
  const auto own_name = [](const WantedColumn& column) { return column.words + "_" + column.unit; };
  const ForeignTable table = table_with_units(file, "a drive", {own_name(first), own_name(second)},
                                              {first.unit, second.unit});
  const QuantityColumn at = find_column(table, first);
  return time_curve_of(at, find_column(table, second), true);
}

TimeCurve read_share_curve(const std::filesystem::path& file) {
  static const UnitOfMeasure kNone{.name = "", .quantity = "Share"};
  const ForeignTable table = table_with_units(file, "a load", {"time_s", "share"}, {"s", ""});
  const auto share = std::find_if(table.header.begin(), table.header.end(),
                                  [](const auto& name) { return lower_case(name) == "share"; });
  if (share == table.header.end())
    throw InputError(file.string() +
                     ": header must be time_s,share; the time may have another unit; its columns "
                     "are " +
                     joined(table.header));
  return time_curve_of(find_column(table, kTimeColumn),
                       {table, static_cast<std::size_t>(share - table.header.begin()), &kNone},
                       false);
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

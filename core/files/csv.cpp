#include "bentaxis/files/csv.h"

// Single-threaded reading keeps the library free of threads it does not need.
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/input_limits.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/joint.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis {
namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

namespace {

// Whether a table is not separated by commas: by semicolons, tabs or blanks, or is no plain text.
// Judged by its first line alone, so that a file of ours is held to its format line by line.
bool is_foreign(std::string_view content) {
  for (const std::string_view start : {"PK\x03\x04", "MATLAB", "\x89HDF", "\xFF\xFE", "\xFE\xFF"})
    if (content.starts_with(start)) return true;
  const auto from = content.find_first_not_of(" \t\r\n");
  if (from == std::string_view::npos) return false;
  std::string_view line = content.substr(from);
  line = trimmed(line.substr(0, line.find('\n')));
  if (line.find('\0') != std::string_view::npos) return false;
  return line.find_first_of(";\t") != std::string_view::npos ||
         (line.find(',') == std::string_view::npos && line.find(' ') != std::string_view::npos);
}

}  // namespace

NumericTable read_numeric_csv(const std::filesystem::path& file, bool allow_empty) {
  const std::string content = read_input_file(file, {"a table", kLargestTable});
  if (!is_foreign(content)) return numeric_csv_of(content, file, allow_empty);
  ForeignTable table = table_of(content, file);
  for (std::size_t i = 0; i < table.rows.size() && !allow_empty; ++i)
    for (std::size_t c = 0; c < table.rows[i].size(); ++c)
      if (!is_computed(table.rows[i][c]))
        throw InputError(table.place(i) + ": " + table.header[c] +
                         " = \"\": must be a finite number");
  return table;
}

NumericTable numeric_csv_of(const std::string& content, const std::filesystem::path& file,
                            bool allow_empty) {
  InputLog::note(file, content);
  if (const auto at = content.find('\0'); at != std::string::npos)
    throw InputError(file.string() + ":" +
                     std::to_string(1 + std::count(content.data(), content.data() + at, '\n')) +
                     ": holds a byte 0: must be text");
  NumericTable table;
  try {
    io::LineReader reader(file.string(), content.data(), content.data() + content.size());
    while (char* text = reader.next_line()) {
      const std::string where = file.string() + ":" + std::to_string(reader.get_file_line());
      if (trimmed(text).empty()) continue;
      const auto fields = split(text);
      if (table.header.empty()) {
        table.header.assign(fields.begin(), fields.end());
        for (const std::string& name : table.header)
          if (has_control_characters(name, true))
            throw InputError(where + ": the column name \"" + without_control_characters(name) +
                             "\" holds a control character");
        continue;
      }
      if (fields.size() != table.header.size())
        throw InputError(where + ": " + std::to_string(fields.size()) + " fields, the header has " +
                         std::to_string(table.header.size()));
      std::vector<double> row;
      row.reserve(fields.size());
      for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto field = fields[i];
        const auto value = number_in(field);
        if (!value && !(field.empty() && allow_empty))
          throw InputError(where + ": " + table.header[i] + " = \"" +
                           without_control_characters(std::string(field)) +
                           "\": must be a finite number");
        row.push_back(value.value_or(not_computed()));
      }
      table.rows.push_back(std::move(row));
      table.lines.push_back(reader.get_file_line());
    }
  } catch (const io::error::base& error) {
    std::string what = error.what();
    while (!what.empty() && (what.back() == '\n' || what.back() == '.')) what.pop_back();
    throw InputError(file.string() + ": cannot be read: " + what);
  }
  if (table.header.empty()) throw InputError(file.string() + ": is empty");
  return table;
}

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
      std::string name = table.header[c];
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
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

[[noreturn]] void refuse_value(const std::filesystem::path& file, const NumericTable& table,
                               std::size_t row, std::size_t column, const std::string& range) {
  throw InputError(file.string() + ":" + std::to_string(table.lines[row]) + ": " +
                   table.header[column] + " = " + number_text(table.rows[row][column]) +
                   ": must be " + range);
}

// The points of an input.
NumericTable points_in(const std::filesystem::path& file) {
  NumericTable table = read_numeric_csv(file);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    for (std::size_t c = 0; c < table.rows[i].size(); ++c)
      if (std::abs(table.rows[i][c]) > kLargestInput)
        refuse_value(file, table, i, c, "of a magnitude up to " + number_text(kLargestInput));
  return table;
}

// The angle of a row over the turn, after those before it.
double next_angle(const std::filesystem::path& file, const NumericTable& table, std::size_t row,
                  const std::vector<double>& before) {
  const double theta = table.rows[row][0];
  if (before.empty()) return theta;
  if (!(theta > before.back()))
    refuse_value(file, table, row, 0,
                 "> " + number_text(before.back()) + " (angles increase strictly)");
  if (!(theta - before.front() < 360))
    refuse_value(file, table, row, 0,
                 "< " + number_text(before.front() + 360) +
                     " (a turn after the first; the end point is not repeated)");
  return theta;
}

[[noreturn]] void refuse_count(const std::filesystem::path& file, std::size_t points,
                               std::size_t fewest) {
  throw InputError(file.string() + ": has " + counted(points, "point") + ", must be at least " +
                   std::to_string(fewest));
}

}  // namespace

OpeningTable read_opening_table(const std::filesystem::path& file) {
  const NumericTable table = points_in(file);
  if (table.header != std::vector<std::string>{"theta_deg", "area_mm2"})
    throw InputError(file.string() + ":1: header must be theta_deg,area_mm2");
  OpeningTable opening{file, {}, {}};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double theta = next_angle(file, table, i, opening.theta_deg);
    if (!(table.rows[i][1] >= 0)) refuse_value(file, table, i, 1, ">= 0");
    opening.theta_deg.push_back(theta);
    opening.area.push_back(square_metres(table.rows[i][1]));
  }
  constexpr std::size_t kFewestPoints = 3;
  if (opening.area.size() < kFewestPoints) refuse_count(file, opening.area.size(), kFewestPoints);
  if (*std::max_element(opening.area.begin(), opening.area.end()) == 0)
    throw InputError(file.string() + ": area_mm2 is 0 at every angle: must be > 0 somewhere");
  return opening;
}

StrokeTable read_stroke_table(const std::filesystem::path& file) {
  const NumericTable table = points_in(file);
  using Header = std::vector<std::string>;
  StrokeTable stroke{file, {}, {}, table.header == Header{"theta_deg", "volume_cm3"}};
  if (!stroke.is_volume && table.header != Header{"theta_deg", "stroke_mm"})
    throw InputError(file.string() +
                     ":1: header must be theta_deg,stroke_mm or theta_deg,volume_cm3");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double theta = next_angle(file, table, i, stroke.theta_deg);
    const double value = table.rows[i][1];
    if (stroke.is_volume && !(value > 0)) refuse_value(file, table, i, 1, "> 0");
    stroke.theta_deg.push_back(theta);
    stroke.value.push_back(stroke.is_volume ? value / 1e6 : metres(value));
  }
  constexpr std::size_t kFewestPoints = 4;
  if (stroke.value.size() < kFewestPoints) refuse_count(file, stroke.value.size(), kFewestPoints);
  const auto [least, greatest] = std::minmax_element(stroke.value.begin(), stroke.value.end());
  if (*least == *greatest)
    throw InputError(file.string() + ": " + table.header[1] +
                     " is the same at every angle: the pistons have no stroke");
  return stroke;
}

namespace {

// Of a value over `first`, times or speeds, as the file has it.
TimeCurve read_time_curve(const std::filesystem::path& file, const std::string& first,
                          const std::string& second, bool negative) {
  const NumericTable table = points_in(file);
  if (table.header != std::vector<std::string>{first, second})
    throw InputError(file.string() + ":1: header must be " + first + "," + second);
  const bool in_time = first == "time_s";
  TimeCurve curve{file, {}, {}};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double at = table.rows[i][0];
    if (i == 0 && at > 0 && in_time)
      refuse_value(file, table, i, 0, "<= 0 (a simulation starts at 0)");
    if (i > 0 && !(at > curve.time.back()))
      refuse_value(file, table, i, 0,
                   "> " + number_text(curve.time.back()) + ", the one before it (" +
                       (in_time ? "times" : "speeds") + " increase strictly)");
    if (!negative && !(table.rows[i][1] >= 0)) refuse_value(file, table, i, 1, ">= 0");
    curve.time.push_back(at);
    curve.value.push_back(table.rows[i][1]);
  }
  constexpr std::size_t kFewestPoints = 4;
  if (curve.time.size() < kFewestPoints)
    throw InputError(file.string() + ": points: " + std::to_string(curve.time.size()) +
                     ", must be at least 4");
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
  const NumericTable table = points_in(file);
  if (table.header != std::vector<std::string>{"tooth", "shaft_um", "block_um"})
    throw InputError(file.string() + ":1: header must be tooth,shaft_um,block_um");
  if (table.rows.size() != static_cast<std::size_t>(teeth.count))
    throw InputError(file.string() + ": has " + counted(table.rows.size(), "tooth", "teeth") +
                     ", must be tooth_number = " + std::to_string(teeth.count));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i][0] != static_cast<double>(i + 1))
      refuse_value(file, table, i, 0, std::to_string(i + 1) + " (teeth in their order)");
    teeth.shaft.pitch.push_back(table.rows[i][1] / 1e6);
    teeth.block.pitch.push_back(table.rows[i][2] / 1e6);
  }
}

std::vector<double> read_clearance_deviations(const std::filesystem::path& file, int pistons) {
  const NumericTable table = points_in(file);
  if (table.header != std::vector<std::string>{"piston", "deviation_um"})
    throw InputError(file.string() + ":1: header must be piston,deviation_um");
  if (table.rows.size() != static_cast<std::size_t>(pistons))
    throw InputError(file.string() + ": has " + counted(table.rows.size(), "piston") +
                     ", must be [pump] pistons = " + std::to_string(pistons));
  std::vector<double> deviation(table.rows.size());
  std::vector<bool> given(table.rows.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double number = table.rows[i][0];
    if (!(number >= 1 && number <= pistons) || number != std::floor(number))
      refuse_value(file, table, i, 0, "a whole number in [1, " + std::to_string(pistons) + "]");
    const auto piston = static_cast<std::size_t>(number) - 1;
    if (given[piston]) refuse_value(file, table, i, 0, "a piston that is not given before");
    given[piston] = true;
    deviation[piston] = table.rows[i][1] / 1e6;
  }
  return deviation;
}

// The columns that say how shaft and block move, in the order of their use.
constexpr const char* kMotionColumns[] = {"theta_deg", "psi_deg",          "theta_rpm",
                                          "psi_rpm",   "theta_rad_per_s2", "psi_rad_per_s2"};

States read_states(const std::filesystem::path& file, const Case& the_case,
                   const PressureTrace& pressure) {
  return states_of(read_numeric_csv(file), file, file.string() + ":1", the_case, pressure);
}

States states_of(const NumericTable& table, const std::filesystem::path& file,
                 const std::string& head, const Case& the_case, const PressureTrace& pressure) {
  const int pistons = the_case.pump.geometry.pistons;
  std::map<std::string, std::size_t> columns;
  std::set<std::string> known(std::begin(kMotionColumns), std::end(kMotionColumns));
  known.insert({"time_s", "suction_bar", "delivery_bar"});
  const auto chamber = [](int k) { return "p_" + std::to_string(k + 1) + "_bar"; };
  for (int k = 0; k < pistons; ++k) known.insert(chamber(k));
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const std::string& name = table.header[c];
    if (known.count(name) == 0)
      throw InputError(head + ": unknown column \"" + name + "\"" + suggestion(name, known));
    if (!columns.emplace(name, c).second)
      throw InputError(head + ": column \"" + name + "\" is a duplicate column");
  }
  const auto has = [&](const std::string& name) { return columns.count(name) > 0; };
  const auto require = [&](const std::string& name) {
    if (!has(name)) throw InputError(head + ": column \"" + name + "\" is missing");
  };
  // A joint says how the block moves: its columns may be left out, all of them.
  const bool joint = the_case.pump.transfer.is_joint();
  const bool block_given = !joint || has("psi_deg") || has("psi_rpm") || has("psi_rad_per_s2");
  for (const char* const name : kMotionColumns)
    if (block_given || std::string(name).rfind("psi_", 0) != 0) require(name);
  const bool pressures = has(chamber(0));
  for (int k = 0; k < pistons; ++k)
    if (has(chamber(k)) || pressures) {
      require(chamber(0));
      require(chamber(k));
    }
  if (table.rows.empty()) throw InputError(file.string() + ": has no states");

  States states;
  states.pistons = pistons;
  states.header = table.header;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    const auto at = [&](const std::string& name) { return row[columns.at(name)]; };
    states.given.insert(states.given.end(), row.begin(), row.end());
    if (has("time_s")) {
      if (i > 0 && at("time_s") < states.time.back())
        refuse_value(file, table, i, columns.at("time_s"),
                     ">= " + number_text(states.time.back()) + " (times must not decrease)");
      states.time.push_back(at("time_s"));
    }
    MotionState state;
    state.theta_deg = at("theta_deg");
    state.shaft_speed = rad_per_second(at("theta_rpm"));
    state.shaft_acceleration = at("theta_rad_per_s2");
    if (block_given) {
      state.psi_deg = at("psi_deg");
      state.block_speed = rad_per_second(at("psi_rpm"));
      state.block_acceleration = at("psi_rad_per_s2");
    }
    if (joint) {
      // The lead alone keeps its digits over many turns.
      const double turned = std::fmod(state.theta_deg, 360.0);
      const AxisMotion block = joint_motion(
          the_case.pump, {radians(turned), state.shaft_speed, state.shaft_acceleration});
      MotionState law = state;
      law.psi_deg = the_case.pump.transfer.is_even()
                        ? state.theta_deg
                        : state.theta_deg + (block.angle - radians(turned)) / kRadPerDegree;
      law.block_speed = block.speed;
      law.block_acceleration = block.acceleration;
      constexpr double kMatch = 1e-9;  // deg, and of the shaft's rates
      const auto hold = [&](const char* name, double given, double wanted, double unit,
                            double tolerance) {
        if (block_given && !(std::abs(given - wanted) <= tolerance))
          refuse_value(file, table, i, columns.at(name),
                       number_text(wanted / unit) + ", as [transfer] kind = \"" +
                           to_string(the_case.pump.transfer.kind) + "\" turns the block");
      };
      hold("psi_deg", state.psi_deg, law.psi_deg, 1, kMatch);
      hold("psi_rpm", state.block_speed, law.block_speed, kRadPerSecondPerRpm,
           kMatch * std::abs(state.shaft_speed));
      hold("psi_rad_per_s2", state.block_acceleration, law.block_acceleration, 1,
           kMatch * (std::abs(state.shaft_acceleration) + state.shaft_speed * state.shaft_speed));
      state = law;
    }
    const Geometry& geometry = the_case.pump.geometry;
    for (int k = 0; k < pistons; ++k) {
      const double phase = 360.0 * k / pistons;
      const double needed = joint_distance(geometry, radians(state.theta_deg - phase),
                                           radians(state.psi_deg - phase));
      if (!(needed < geometry.piston_length))
        refuse_value(file, table, i, columns.at(block_given ? "psi_deg" : "theta_deg"),
                     "closer to theta_deg = " + number_text(state.theta_deg) +
                         ": the pump cannot be assembled, piston " + std::to_string(k + 1) +
                         " would have to be longer than " + number_text(needed * 1e3) + " mm");
    }
    state.ports = the_case.pressure.ports;
    if (has("suction_bar")) state.ports.suction = pascals(at("suction_bar"));
    if (has("delivery_bar")) state.ports.delivery = pascals(at("delivery_bar"));
    states.motion.push_back(state);
    for (int k = 0; k < pistons; ++k)
      states.chamber_pressure.push_back(
          pressures ? pascals(at(chamber(k)))
                    : pressure(piston_angle_deg(state.psi_deg, k + 1, pistons)));
  }
  return states;
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

namespace {

bool is_written(const ResultTable& table, std::size_t column) {
  if (!is_of_given_motion(table.channels[column])) return true;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (is_computed(table.at(row, column))) return true;
  return false;
}

// A text that is handed on whenever enough of it has come together.
class Pieces {
 public:
  explicit Pieces(const TextSink& write) : write_(write) {}
  std::string& next() {
    constexpr std::size_t kEnough = 1 << 20;
    if (piece.size() >= kEnough) end();
    return piece;
  }
  void end() {
    write_(piece);
    piece.clear();
  }
  std::string piece;

 private:
  const TextSink& write_;
};

template <class Writes>
std::string text_of(const Writes& writes) {
  std::string text;
  writes([&](const std::string& piece) { text += piece; });
  return text;
}

}  // namespace

std::string to_csv(const MotionTable& table) {
  return text_of([&](const TextSink& write) { write_csv(table, write); });
}

void write_csv(const MotionTable& table, const TextSink& write) {
  const ResultTable& results = table.results;
  Pieces text(write);
  std::vector<std::size_t> columns;  // those that the states do not have already: given pressures
  const auto& names = table.state_names;
  for (const std::string& name : names) text.piece += name + ",";
  for (std::size_t c = 0; c < results.columns(); ++c)
    if (is_written(results, c) && !contains(names, results.channels[c].name)) {
      columns.push_back(c);
      text.piece += results.channels[c].name + ",";
    }
  text.piece.back() = '\n';
  std::vector<double> line;
  for (std::size_t row = 0; row < results.rows(); ++row) {
    line.clear();
    for (std::size_t c = 0; c < names.size(); ++c) line.push_back(table.state(row, c));
    for (const std::size_t c : columns) line.push_back(results.at(row, c));
    append_csv_row(text.next(), line[0], line.data() + 1, line.size() - 1);
  }
  text.end();
}

std::string oil_csv(const Trajectory& run) {
  return text_of([&](const TextSink& write) { write_oil_csv(run, write); });
}

void write_oil_csv(const Trajectory& run, const TextSink& write) {
  Pieces text(write);
  text.piece = "time_s";
  for (const OilColumn& column : run.oil->columns) text.piece += "," + column.name;
  text.piece += "\n";
  const std::size_t columns = run.oil->columns.size();
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    append_csv_row(text.next(), run.table.state(row, 0), run.oil->values.data() + row * columns,
                   columns);
  text.end();
}

std::string csv_header(const std::vector<Channel>& channels) {
  std::string text = "theta_deg";
  for (const Channel& channel : channels) text += "," + channel.name;
  return text + "\n";
}

void append_csv_row(std::string& text, double theta_deg, const double* values, std::size_t count) {
  append_number(text, theta_deg);
  for (std::size_t column = 0; column < count; ++column) {
    text += ',';
    append_number(text, values[column]);
  }
  text += '\n';
}

std::string to_csv(const ResultTable& table) {
  return text_of([&](const TextSink& write) { write_csv(table, write); });
}

void write_csv(const ResultTable& table, const TextSink& write,
               const std::function<bool(const Channel&)>& wanted) {
  std::vector<Channel> channels;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.columns(); ++c)
    if ((!wanted || wanted(table.channels[c])) && is_written(table, c)) {
      columns.push_back(c);
      channels.push_back(table.channels[c]);
    }
  Pieces text(write);
  text.piece = csv_header(channels);
  std::vector<double> line(columns.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) line[i] = table.at(row, columns[i]);
    append_csv_row(text.next(), table.theta_deg[row], line.data(), line.size());
  }
  text.end();
}

}  // namespace bentaxis

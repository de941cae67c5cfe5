#include "mapping_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"

namespace bentaxis::study::mapping {
namespace {

// A record across a wider gap is none of a turn.
constexpr double kShortestRecord = 330;
// From the last sample to the end of the turn there are at most so many of the widest steps.
constexpr double kWidestGap = 2.5;

bool is_word_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '?'; }

}  // namespace

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : name + " ") {
    if (is_word_letter(c)) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(lower_case(word));
      word.clear();
    }
  }
  return words;
}

std::vector<std::pair<std::string, int>> axis_readings(const std::string& name) {
  std::vector<std::pair<std::string, int>> readings;
  for (std::size_t i = name.size(); i-- > 0;) {
    const auto at = std::string("xyzXYZ").find(name[i]);
    if (at == std::string::npos) continue;
    std::size_t end = i + 1;
    if (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    if (end < name.size() && is_word_letter(name[end])) continue;
    std::string key = name;
    key[i] = '?';
    readings.emplace_back(key, static_cast<int>(at % 3));
  }
  const auto matrix = name.rfind("(:,");
  if (matrix != std::string::npos && matrix + 5 == name.size() && name[matrix + 3] >= '1' &&
      name[matrix + 3] <= '3') {
    std::string key = name;
    key[matrix + 3] = '?';
    readings.emplace_back(key, name[matrix + 3] - '1');
  }
  return readings;
}

int piston_in(const std::string& name, int pistons) {
  // A number behind these is that of a column.
  static const std::vector<std::string> kCounters = {
      "column", "col", "channel", "chan",  "ch",     "ai",     "var",    "variable",
      "signal", "sig", "data",    "trace", "series", "sensor", "spalte", "kanal"};
  int first = 0;
  for (const bool of_piston : {true, false}) {
    bool near = false;            // behind a word for pistons
    bool counts_columns = false;  // behind a word for columns
    for (const auto& word : words_of(name)) {
      if (word.find('?') != std::string::npos) continue;
      const std::string stem = word.substr(0, word.find_last_not_of("0123456789") + 1);
      counts_columns = !near && (stem.empty() ? counts_columns : contains(kCounters, stem));
      if (counts_columns) continue;
      near = near || word.find("pist") != std::string::npos || word.find("kolben") == 0 ||
             word.find("cyl") == 0 || word.find("chamber") == 0;
      const auto digits = word.find_last_not_of("0123456789") + 1;
      if (digits >= word.size() || word.size() - digits > 3) continue;
      const int number = std::stoi(word.substr(digits));
      if (number < 1 || number > pistons || (of_piston && !near)) continue;
      if (first == 0) first = number;
    }
    if (first != 0) return first;
  }
  return 0;
}

bool is_quantity(const std::vector<std::string>& words, const std::string& quantity) {
  return contains(words, lower_case(quantity));
}

bool named(const std::vector<std::string>& words, const Channel& channel) {
  if (channel.quantity == "Td" && contains(words, "torque")) return true;
  auto needed = words_of(channel.name);
  needed.pop_back();  // the unit may differ
  return std::all_of(needed.begin(), needed.end(),
                     [&](const auto& word) { return contains(words, word); });
}

bool may_have(const std::string& unit, const std::string& channel_unit) {
  const auto* const known = compare::find_unit(unit);
  return known == nullptr || known->family == channel_unit;
}

double half_of_last_digit(double number, int digits) {
  return std::pow(10.0, std::floor(std::log10(number)) - digits + 1) / 2;
}

namespace {

// A column as angles in degrees, of which one that begins anew in every turn goes on; empty where
// it lacks a value.
Series angles_of(const ForeignTable& table, std::size_t column, double scale, bool is_time) {
  Series angles;
  double turns = 0;
  for (const auto& row : table.rows) {
    if (!is_computed(row[column])) return {};
    const double angle = scale * row[column];
    if (!angles.empty() && !is_time) {
      const double step = angle + turns - angles.back();
      if (std::abs(step) > 180 && std::abs(step) <= 360 + 1e-9) turns += step > 0 ? -360 : 360;
    }
    angles.push_back(angle + turns);
  }
  return angles;
}

// Strictly and to the end of a turn: what lacks more than a sample or two of it has been cut off.
bool makes_turns(const Series& angles) {
  constexpr double kMaxTurns = 1000;
  if (angles.size() < 6) return false;
  const double rises = angles.back() > angles.front() ? 1 : -1;
  double widest = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const double step = rises * (angles[i] - angles[i - 1]);
    if (!(step > 0)) return false;
    widest = std::max(widest, step);
  }
  const double span = std::abs(angles.back() - angles.front());
  return span >= 360 - kWidestGap * widest && span >= kShortestRecord && span <= kMaxTurns * 360 &&
         span / static_cast<double>(angles.size() - 1) <= 30;
}

// How far angles are from equal steps, or from multiples of a step where rows are missing: 0, 0.5,
// 1, .. are exact, however few digits they have.
double unevenness(const Series& angles) {
  const double whole = angles.back() - angles.front();
  double uneven = 0, off_grid = 0, least = std::abs(whole);
  for (std::size_t i = 1; i < angles.size(); ++i)
    least = std::min(least, std::abs(angles[i] - angles[i - 1]));
  const double step = whole / static_cast<double>(angles.size() - 1);
  const double grid = whole / std::round(std::abs(whole) / least);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double past = angles[i] - angles.front();
    uneven = std::max(uneven, std::abs(past - step * static_cast<double>(i)));
    off_grid = std::max(off_grid, std::abs(past - grid * std::round(past / grid)));
  }
  return std::min({uneven, off_grid, least / 2});
}

}  // namespace

bool is_record(const ForeignTable& table, std::size_t column, double degrees_per_second,
               AngleMap& map) {
  const double scale = map.degrees_per_unit * (map.is_time ? degrees_per_second : 1);
  const Series angles = angles_of(table, column, scale, map.is_time);
  if (!makes_turns(angles)) return false;
  const int digits = table.digits[column];
  if (digits > 0 && digits < 12) {
    double largest = 0;
    for (const auto& row : table.rows) largest = std::max(largest, std::abs(row[column]));
    // Half a unit of the last digit, but no more than the angles show.
    map.rounding_deg =
        std::min(unevenness(angles), std::abs(scale) * half_of_last_digit(largest, digits));
    if (map.rounding_deg < 1e-9) map.rounding_deg = 0;
  }
  // The last turn of a longer record: by then it has settled.
  const double same = std::max(1e-9, 2 * map.rounding_deg);
  const double along = angles.back() - angles.front();
  if (std::abs(along) > 360 + same)
    map.turn_from_deg = along > 0 ? angles.back() - 360 : angles.back();
  return true;
}

std::vector<AngleMap> angle_choices(const ForeignTable& table, double degrees_per_second) {
  std::map<int, std::vector<AngleMap>> by_rank;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const auto words = words_of(table.header[c]);
    const std::string unit = known_unit(table.units[c]);
    const auto says = [&](std::initializer_list<const char*> list) {
      return std::any_of(list.begin(), list.end(),
                         [&](const char* word) { return contains(words, word); });
    };
    const bool angle = says({"theta", "angle", "phi", "rotation", "deg", "degrees", "winkel",
                             "drehwinkel", "alpha", "rot", "psi", "az"});
    const bool time = says({"time", "t", "zeit", "temps", "tempo", "s", "sec", "ms"});
    const auto add = [&](const std::string& name, int rank) {
      AngleMap map;
      map.column = table.header[c];
      map.unit = name;
      map.is_time = compare::seconds_per(name) > 0;
      map.degrees_per_unit = map.is_time ? compare::seconds_per(name) : compare::degrees_per(name);
      if (is_record(table, c, degrees_per_second, map)) by_rank[rank].push_back(map);
    };
    if (compare::degrees_per(unit) > 0) add(unit, angle ? 0 : 1);
    if (compare::seconds_per(unit) > 0) add(unit, 2);
    if (!unit.empty() && compare::degrees_per(unit) == 0 && compare::seconds_per(unit) == 0)
      continue;
    for (const char* name : {"deg", "rad", "turn"})
      if (unit.empty() || compare::seconds_per(unit) == 0) add(name, angle ? 3 : time ? 6 : 5);
    for (const char* name : {"s", "ms"})
      if (unit.empty() || compare::degrees_per(unit) == 0) add(name, time ? 4 : angle ? 6 : 5);
  }
  if (by_rank.empty())
    throw InputError(table.file.string() +
                     ": no column can be the shaft's angle or the time of a whole turn: it must "
                     "increase or decrease strictly over at least 330 deg, and the gap to the end "
                     "of the turn must be at most 2.5 steps wide (is the file truncated, or a "
                     "record over time of another speed than the case's?)");
  return by_rank.begin()->second;
}

bool runs_along(const ForeignTable& table, std::size_t column) {
  bool rises = true, falls = true;
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    rises = rises && table.rows[i][column] > table.rows[i - 1][column];
    falls = falls && table.rows[i][column] < table.rows[i - 1][column];
  }
  return rises || falls;
}

std::size_t Group::count() const {
  return static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [](const auto& c) { return c.has_value(); }));
}

bool is_length(const ForeignTable& table, std::size_t column, const Group& group) {
  constexpr double kSame = 1e-4;
  for (const auto& row : table.rows) {
    double square = 0;
    for (const auto& part : group.columns)
      if (part) square += row[*part] * row[*part];
    if (!(std::abs(std::sqrt(square) - row[column]) <= kSame * std::abs(row[column]))) return false;
  }
  return true;
}

Grouping find_groups(const ForeignTable& table, const std::vector<bool>& has_curve,
                     const std::vector<bool>& constant) {
  Grouping found;
  std::map<std::string, Group> by_key;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    if (!has_curve[c]) continue;
    for (const auto& [key, axis] : axis_readings(table.header[c])) {
      Group& group = by_key[key];
      group.key = key;
      group.columns[static_cast<std::size_t>(axis)] = c;
      if (group.unit.empty()) group.unit = known_unit(table.units[c]);
    }
  }
  std::set<std::size_t> taken;
  // Whole vectors first, in the order of the file.
  std::vector<Group> list;
  for (auto& [key, group] : by_key) list.push_back(group);
  const auto first_of = [](const Group& g) {
    std::size_t first = std::numeric_limits<std::size_t>::max();
    for (const auto& column : g.columns)
      if (column) first = std::min(first, *column);
    return first;
  };
  std::sort(list.begin(), list.end(), [&](const Group& a, const Group& b) {
    return std::pair(3 - a.count(), first_of(a)) < std::pair(3 - b.count(), first_of(b));
  });
  for (const Group& group : list) {
    bool free = group.count() >= 2, moves = false;
    for (const auto& column : group.columns) {
      free = free && (!column || taken.count(*column) == 0);
      moves = moves || (column && !constant[*column]);
    }
    if (!free || !moves) continue;
    found.groups.push_back(group);
    for (const auto& column : group.columns)
      if (column) taken.insert(*column);
  }
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    if (!has_curve[c] || taken.count(c) > 0) continue;
    if (constant[c])
      found.ignored.emplace_back(table.header[c], "is constant");
    else if (const auto of = std::find_if(found.groups.begin(), found.groups.end(),
                                          [&](const Group& g) { return is_length(table, c, g); });
             of != found.groups.end())
      found.ignored.emplace_back(table.header[c], "is the length of " + of->key);
    else
      found.singles.push_back(c);
  }
  return found;
}

void Record::take_turn(const AngleMap& map) {
  const compare::Turn turn = turn_of(map);
  const std::size_t angle = column_of(map.column), columns = table_.header.size();
  over_time_ = map.is_time;
  splines_.assign(columns, std::nullopt);
  constant_.assign(columns, false);
  undecided_.clear();
  std::vector<bool> has_curve(columns, false);
  std::vector<std::pair<std::string, std::string>> without_curve;
  for (std::size_t c = 0; c < columns; ++c) {
    if (c == angle) continue;
    Series values;
    for (const auto row : turn.rows) values.push_back(table_.rows[row][c]);
    if (const std::string defect = defect_of(c, values); !defect.empty()) {
      without_curve.emplace_back(table_.header[c], defect);
      continue;
    }
    has_curve[c] = true;
    constant_[c] = mapping::is_constant(values);
    splines_[c].emplace(turn.theta_deg, values);
  }
  found_ = find_groups(table_, has_curve, constant_);
  found_.ignored.insert(found_.ignored.begin(), without_curve.begin(), without_curve.end());
}

std::string Record::defect_of(std::size_t column, const Series& values) {
  const auto empty = static_cast<std::size_t>(std::count_if(
      values.begin(), values.end(), [](double value) { return !is_computed(value); }));
  if (empty == 0) return runs_along(table_, column) ? "is proportional to the angle" : "";
  // A column that is mostly there is one that somebody wants compared.
  const bool wanted = 2 * empty < values.size();
  if (wanted) undecided_.push_back(table_.header[column]);
  return fmt::format("{}has empty fields: {} of {}", wanted ? "not recognised: " : "", empty,
                     values.size());
}

compare::Turn Record::turn_of(const AngleMap& map) const {
  const std::size_t angle = column_of(map.column);
  std::vector<double> values;
  for (const auto& row : table_.rows) values.push_back(row[angle]);
  return compare::one_turn(
      table_.file.string(), map, values, [&](std::size_t row) { return table_.place(row); },
      degrees_per_second_);
}

bool Record::has_whole_vector() const {
  return std::any_of(groups().begin(), groups().end(),
                     [](const Group& group) { return group.count() == 3; });
}

std::size_t Record::column_of(const std::string& name) const {
  return static_cast<std::size_t>(std::find(table_.header.begin(), table_.header.end(), name) -
                                  table_.header.begin());
}

std::string Record::contradicting_unit(std::size_t column, const std::string& unit) const {
  const std::string known = unit_of(column);
  return known.empty() || known == unit ? "" : table_.units[column];
}

Series Record::sampled(std::size_t column, const Turning& turning, std::size_t count) const {
  Series out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back((*splines_[column])(
        turning.sign *
        (360.0 * static_cast<double>(i) / static_cast<double>(count) - turning.phase)));
  return out;
}

}  // namespace bentaxis::study::mapping

#include "mapping_guess_pieces.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study::mapping {
namespace {

// A record across a wider gap is none of a turn.
constexpr double kShortestRecord = 330;
// From the last sample to the end of the turn there are at most so many of the widest steps.
constexpr double kWidestGap = 2.5;
// Another unit than the one that a column's name says is thought of beyond this factor.
constexpr double kWrongUnit = 1.5;
// Units that are tried where none is said: far enough apart that no error of a model leads from one
// to the next.
constexpr std::array<const char*, 14> kGuessedUnits = {
    "N", "kN", "MN", "lbf", "Nm", "kNm", "Nmm", "lbf in", "m", "mm", "um", "bar", "MPa", "Pa"};

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
Eigen::Map<const Matrix> matrix(const Axes& axes) {
  return Eigen::Map<const Matrix>(axes[0].data());
}
Axes axes_of(const Matrix& matrix) {
  Axes axes;
  Eigen::Map<Matrix>(axes[0].data()) = matrix;
  return axes;
}

bool is_word_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '?'; }

}  // namespace

double dot(const Series& a, const Series& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Series centred(Series values) {
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

Series normalised(const Series& values) {
  const double size = std::sqrt(dot(values, values));
  Series out = centred(values);
  const double length = std::sqrt(dot(out, out));
  for (double& value : out) value = length > 1e-9 * size ? value / length : 0;
  return out;
}

Series length_of(const std::array<Series, 3>& vector) {
  Series out(std::max({vector[0].size(), vector[1].size(), vector[2].size()}), 0);
  for (const auto& component : vector)
    for (std::size_t i = 0; i < component.size(); ++i) out[i] += component[i] * component[i];
  for (double& value : out) value = std::sqrt(value);
  return out;
}

Series coarse(const Series& fine) {
  Series out;
  for (std::size_t i = 0; i < kCoarse; ++i) out.push_back(fine[i * fine.size() / kCoarse]);
  return out;
}

double shifted_product(const Series& ours, const Series& theirs, std::size_t shift) {
  double r = 0;
  for (std::size_t i = 0; i < shift; ++i) r += ours[i] * theirs[i + kCoarse - shift];
  for (std::size_t i = shift; i < kCoarse; ++i) r += ours[i] * theirs[i - shift];
  return r;
}

double roundest(const std::function<double(const std::vector<double>&)>& cost,
                std::vector<double>& angles) {
  constexpr double kAsGood = 0.2;  // of the logarithm of the mean square difference
  const double least = cost(angles);
  for (const double step : {90.0, 45.0, 30.0, 10.0, 5.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.01, 0.005,
                            1e-3, 1e-4, 1e-5, 1e-6}) {
    std::vector<double> round = angles;
    // Divided where the step is a fraction: 17.3 is 173 / 10, and 173 x 0.1 is another number.
    const double per_degree = std::round(1 / step);
    for (double& angle : round)
      angle = step < 1 ? std::round(angle / step) / per_degree : std::round(angle / step) * step;
    const bool near = std::equal(round.begin(), round.end(), angles.begin(),
                                 [](double a, double b) { return std::abs(a - b) < 2; });
    if (!near || cost(round) > least + kAsGood) continue;
    angles = round;
    return step;
  }
  return 0;
}

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

double half_of_last_digit(double number, int digits) {
  return std::pow(10.0, std::floor(std::log10(number)) - digits + 1) / 2;
}

bool is_record(const ForeignTable& table, std::size_t column, double degrees_per_second,
               AngleMap& map) {
  constexpr double kMaxTurns = 1000;
  const double scale = map.degrees_per_unit * (map.is_time ? degrees_per_second : 1);
  std::vector<double> angles;
  double turns = 0, largest = 0;
  for (const auto& row : table.rows) {
    if (!is_computed(row[column])) return false;
    largest = std::max(largest, std::abs(row[column]));
    const double angle = scale * row[column];
    if (!angles.empty() && !map.is_time) {
      const double step = angle + turns - angles.back();
      if (std::abs(step) > 180 && std::abs(step) <= 360 + 1e-9) turns += step > 0 ? -360 : 360;
    }
    angles.push_back(angle + turns);
  }
  if (angles.size() < 6) return false;
  const bool rises = angles.back() > angles.front();
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (rises ? !(angles[i] > angles[i - 1]) : !(angles[i] < angles[i - 1])) return false;
  const double span = std::abs(angles.back() - angles.front());
  double widest = 0;
  for (std::size_t i = 1; i < angles.size(); ++i)
    widest = std::max(widest, std::abs(angles[i] - angles[i - 1]));
  // What lacks more than a sample or two of a turn has been cut off.
  if (span < 360 - kWidestGap * widest) return false;
  if (span < kShortestRecord || span > kMaxTurns * 360 ||
      span / static_cast<double>(angles.size() - 1) > 30)
    return false;
  const int digits = table.digits[column];
  if (digits > 0 && digits < 12) {
    // Half a unit of the last digit; but 0, 0.5, 1, .. are exact, which equal steps show.
    const double whole = angles.back() - angles.front();
    double uneven = 0, off_grid = 0, least = span;
    for (std::size_t i = 1; i < angles.size(); ++i)
      least = std::min(least, std::abs(angles[i] - angles[i - 1]));
    const double step = whole / static_cast<double>(angles.size() - 1);
    // So do multiples of a step, where rows are missing.
    const double grid = whole / std::round(span / least);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double past = angles[i] - angles.front();
      uneven = std::max(uneven, std::abs(past - step * static_cast<double>(i)));
      off_grid = std::max(off_grid, std::abs(past - grid * std::round(past / grid)));
    }
    uneven = std::min({uneven, off_grid, least / 2});
    map.rounding_deg = std::min(uneven, std::abs(scale) * half_of_last_digit(largest, digits));
    if (map.rounding_deg < 1e-9) map.rounding_deg = 0;
  }
  // The last turn of a longer record: by then it has settled.
  const double same = std::max(1e-9, 2 * map.rounding_deg);
  if (span > 360 + same) map.turn_from_deg = rises ? angles.back() - 360 : angles.back();
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
    const bool angle_unit = compare::degrees_per(unit) > 0;
    const bool time_unit = compare::seconds_per(unit) > 0;
    if (angle_unit) add(unit, angle ? 0 : 1);
    if (time_unit) add(unit, 2);
    if (!unit.empty() && !angle_unit && !time_unit) continue;
    for (const char* name : {"deg", "rad", "turn"})
      if (unit.empty() || !time_unit) add(name, angle ? 3 : time ? 6 : 5);
    for (const char* name : {"s", "ms"})
      if (unit.empty() || !angle_unit) add(name, time ? 4 : angle ? 6 : 5);
  }
  if (by_rank.empty())
    throw InputError(table.file.string() +
                     ": no column can be the shaft's angle or the time of a whole turn: it must "
                     "increase or decrease strictly over at least 330 deg, and the gap to the end "
                     "of the turn must be at most 2.5 steps wide (is the file truncated?)");
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

bool is_constant(const Series& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low <= 1e-9 * std::max(std::abs(*low), std::abs(*high));
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

std::string unit_for(double fit, const std::string& ours, double unit_in_si,
                     const std::string& said) {
  const auto distance = [&](const std::string& name) {
    return std::abs(std::log(std::abs(fit) * compare::find_unit(name)->si / unit_in_si));
  };
  const auto* known = compare::find_unit(said);
  if (known != nullptr && known->family == ours && distance(said) < std::log(kWrongUnit))
    return said;
  std::string best;
  for (const char* name : kGuessedUnits)
    if (compare::find_unit(name)->family == ours &&
        (best.empty() || distance(name) < distance(best)))
      best = name;
  if (known != nullptr && known->family == ours && distance(best) > std::log(kWrongUnit))
    return said;
  return best;
}

Match match_of(double square, double product, double own, const std::string& ours,
               double unit_in_si, const std::string& said, int wanted) {
  Match m;
  if (own <= 0 || product == 0) return m;
  m.sign = wanted != 0 ? wanted : product < 0 ? -1 : 1;
  m.unit = unit_for(product / own, ours, unit_in_si, said);
  if (m.unit.empty()) return m;
  const double factor = m.sign * unit_in_si / compare::find_unit(m.unit)->si;
  m.cost = std::sqrt(std::max(0.0, square - 2 * factor * product + factor * factor * own) / square);
  return m;
}

void add_component(const Products& p, const Axes& axes, std::size_t j, double& product,
                   double& own) {
  for (std::size_t i = 0; i < 3; ++i) {
    product += axes[j][i] * p.theirs_ours[j][i];
    for (std::size_t k = 0; k < 3; ++k) own += axes[j][i] * axes[j][k] * p.ours_ours[i][k];
  }
}

double cost_without_signs(const Products& p, const Axes& axes, double factor) {
  double difference = 0, square = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    if (!p.theirs_theirs[j]) continue;
    double product = 0, own = 0;
    add_component(p, axes, j, product, own);
    difference += *p.theirs_theirs[j] - 2 * factor * std::abs(product) + factor * factor * own;
    square += *p.theirs_theirs[j];
  }
  return std::sqrt(std::max(0.0, difference) / square);
}

double cost_of_mixed(const Products& p, const Axes& axes, double factor) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  double least = std::numeric_limits<double>::max();
  do {
    const Axes ordered = {axes[order[0]], axes[order[1]], axes[order[2]]};
    least = std::min(least, cost_without_signs(p, ordered, factor));
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

Axes carried(const Axes& axes, const Axes& from, const Axes& to) {
  return axes_of(matrix(axes) * matrix(from) * matrix(to).transpose());
}

std::array<Series, 3> in_axes(const std::array<Series, 3>& parts, const Axes& from,
                              const Axes& to) {
  const Matrix cosines = matrix(to) * matrix(from).transpose();
  std::array<Series, 3> out;
  for (int j = 0; j < 3; ++j)
    for (std::size_t row = 0; row < parts[0].size(); ++row)
      out[j].push_back(
          cosines.row(j).dot(Eigen::RowVector3d(parts[0][row], parts[1][row], parts[2][row])));
  return out;
}

const std::vector<Axes>& right_angles() {
  static const std::vector<Axes> all = [] {
    std::vector<Axes> list;
    std::array<std::size_t, 3> order = {0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Axes axes{};
        for (std::size_t j = 0; j < 3; ++j) axes[j][order[j]] = (signs >> j & 1) != 0 ? -1 : 1;
        if (matrix(axes).determinant() > 0) list.push_back(axes);
      }
    } while (std::next_permutation(order.begin(), order.end()));
    return list;
  }();
  return all;
}

double trace_of(const Axes& a, const Axes& b) { return matrix(a).cwiseProduct(matrix(b)).sum(); }

double angle_from_right_angles(const Axes& axes) {
  double cosine = -1;
  for (const Axes& other : right_angles())
    cosine = std::max(cosine, (trace_of(axes, other) - 1) / 2);
  return std::acos(std::min(1.0, cosine)) / kRadPerDegree;
}

std::array<double, 3> euler_angles(const Axes& axes, const std::string& sequence) {
  const auto& z = axes[2];
  std::array<double, 3> angles{};
  if (sequence == "ZXZ")
    angles = {std::atan2(z[0], -z[1]), std::atan2(std::hypot(z[0], z[1]), z[2]), 0};
  else
    angles = {std::atan2(-z[1], z[2]), std::atan2(z[0], std::hypot(z[1], z[2])), 0};
  for (double& angle : angles) angle /= kRadPerDegree;
  // The third one from the axes that the first two leave.
  const Axes before = compare::turned_axes(sequence, angles);
  const auto along = [&](const std::array<double, 3>& axis) {
    return std::inner_product(axis.begin(), axis.end(), axes[0].begin(), 0.0);
  };
  angles[2] = std::atan2(along(before[1]), along(before[0])) / kRadPerDegree;
  return angles;
}

Axes nearest_rotation(const std::vector<Axes>& products, const std::vector<double>& weights) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < products.size(); ++i) sum += weights[i] * matrix(products[i]);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // A rotation and no reflection: the sign is that of the direction which the vectors show least.
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  return axes_of(svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() *
                 svd.matrixV().transpose());
}

std::function<int(int)> best_numbering(const std::vector<std::pair<int, int>>& votes, int pistons) {
  // Numbered against the rotation: only where enough pistons show it, for of two or three it
  // could be that two were mixed up.
  constexpr std::size_t kShowReversal = 4;
  std::set<int> different;
  for (const auto& [said, looks] : votes) different.insert(said);
  int most = -1, first = 0, direction = 1;
  for (const int d : {1, -1})
    for (int m = 0; m < pistons; ++m) {
      int count = 0;
      for (const auto& [said, looks] : votes)
        count += (d * (said - 1) + m + pistons) % pistons + 1 == looks;
      if (count > most && (d > 0 || different.size() >= kShowReversal)) {
        most = count;
        first = m;
        direction = d;
      }
    }
  return [=](int said) { return (direction * (said - 1) + first + pistons) % pistons + 1; };
}

}  // namespace bentaxis::study::mapping

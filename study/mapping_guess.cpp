#include "bentaxis/study/mapping_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {
namespace {

using compare::AngleMap;
using compare::Axes;
using Series = std::vector<double>;  // over the turn at equal steps

// The coarse search for the phase has this many angles in the turn.
constexpr std::size_t kCoarse = 180;
// A record across a wider gap is none of a turn.
constexpr double kShortestRecord = 330;
// A curve that differs by more than this share of itself from every channel is none of them.
constexpr double kNoChannel = 0.5;
// Frames at right angles that leave more than this are held against frames at Euler angles.
constexpr double kPoorFrame = 0.02;
constexpr int kEulerStep = 5;  // deg
// Another unit than the one that a column's name says is thought of beyond this factor.
constexpr double kWrongUnit = 1.5;
// Units that are tried where none is said: far enough apart that no error of a model leads from one
// to the next.
constexpr std::array<const char*, 14> kGuessedUnits = {
    "N", "kN", "MN", "lbf", "Nm", "kNm", "Nmm", "lbf in", "m", "mm", "um", "bar", "MPa", "Pa"};

double dot(const Series& a, const Series& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Series centred(Series values) {
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

// About the mean and of length 1; zero where the curve is constant.
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

// ---- Names --------------------------------------------------------------------------------------

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_word_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '?'; }

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : name + " ") {
    if (is_word_letter(c)) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(lower(word));
      word.clear();
    }
  }
  return words;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Places in a name that may be the letter of an axis: a word's last letter but for one digit behind
// it ("FX", "x2", "Force_y"), or columns 1 to 3 of a matrix. The name with '?' there, and the axis.
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

// The number of a piston that a name has; 0 = none. Never that of an axis.
int piston_in(const std::string& name, int pistons) {
  int first = 0;
  for (const bool of_piston : {true, false}) {
    bool near = false;  // behind a word for pistons
    for (const auto& word : words_of(name)) {
      if (word.find('?') != std::string::npos) continue;
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

// ---- What the model offers
// -----------------------------------------------------------------------

struct ModelVector {
  std::string ours, quantity, frame, unit;
  int piston = 0;
  double unit_in_si = 1, peak = 0;
  std::array<Series, 3> parts;
  std::array<bool, 3> has_channel{};
  std::array<std::string, 3> names;
};

struct ModelChannel {
  Channel channel;
  double peak = 0;
  Series values;
};

bool is_quantity(const std::vector<std::string>& words, const std::string& quantity) {
  return contains(words, lower(quantity));
}

// ---- The guess ----------------------------------------------------------------------------------

struct Group {
  std::string key;
  std::array<std::optional<std::size_t>, 3> columns;
  std::string unit;
  std::size_t count() const {
    return static_cast<std::size_t>(
        std::count_if(columns.begin(), columns.end(), [](const auto& c) { return c.has_value(); }));
  }
};

struct FrameChoice {
  std::string axes_of;
  Axes axes = compare::kNoTurn;
  std::string euler;  // sequence, where it was turned by such angles
  std::array<double, 3> angles{};
  bool plain() const { return axes == compare::kNoTurn; }
};

// A vector or a channel that stands for a group or column.
struct Match {
  std::size_t index = std::numeric_limits<std::size_t>::max();
  int sign = 1;
  std::string unit;
  double cost = 2;            // rms of the difference over rms of theirs
  bool signs_differ = false;  // it would fit with other signs of single components
  bool found() const { return index != std::numeric_limits<std::size_t>::max(); }
};

struct Assignment {
  double cost = 0;
  FrameChoice frame;
  std::vector<Match> groups, columns;
  int numbered = 0;  // pistons that have the number which their names say
};

class Guesser {
 public:
  Guesser(const ForeignTable& table, const ResultTable& model, const compare::FrameAxes& frames,
          double degrees_per_second)
      : table_(table), frames_(frames), degrees_per_second_(degrees_per_second), n_(model.rows()) {
    read_model(model);
  }

  MappingGuess guess() {
    const auto choices = angle_choices();
    double least = std::numeric_limits<double>::max();
    std::optional<Found> best;
    for (const AngleMap& choice : choices) {
      take_turn(choice);
      for (const Found& found : phases()) {
        if (!best || found.cost < least) {
          least = found.cost;
          best = found;
          best->angle = choice;
        }
      }
    }
    if (!best)
      throw InputError(table_.file.string() +
                       ": no column follows any of the model's curves; is it of this case?");
    take_turn(best->angle);
    return finish(*best);
  }

 private:
  struct Found {
    AngleMap angle;
    double sign = 1, phase = 0, cost = 0;
  };

  void read_model(const ResultTable& model) {
    std::map<std::string, std::size_t> by_name;
    for (std::size_t c = 0; c < model.columns(); ++c) {
      const Channel& channel = model.channels[c];
      if (channel.kind == ChannelKind::check) continue;
      pistons_ = std::max(pistons_, channel.piston);
      ModelChannel one{channel, model.peak(channel.group), {}};
      for (std::size_t row = 0; row < n_; ++row) one.values.push_back(model.at(row, c));
      if (!std::all_of(one.values.begin(), one.values.end(), is_computed) || one.peak == 0)
        continue;
      channels_.push_back(one);
      if (channel.axis.empty() || (channel.frame != "S1" && channel.frame != "S2")) continue;
      const std::string name =
          channel.quantity + (channel.piston > 0 ? "_" + std::to_string(channel.piston) : "");
      const auto [it, added] = by_name.emplace(name, vectors_.size());
      if (added) {
        vectors_.push_back({name,
                            channel.quantity,
                            channel.frame,
                            channel.unit,
                            channel.piston,
                            channel.unit_in_si,
                            one.peak,
                            {},
                            {},
                            {}});
        for (auto& part : vectors_.back().parts) part.assign(n_, 0);
      }
      const auto axis = static_cast<std::size_t>(channel.axis.front() - 'x');
      ModelVector& vector = vectors_[it->second];
      vector.parts[axis] = one.values;
      vector.has_channel[axis] = true;
      vector.names[axis] = channel.name;
    }
    // One component is a number, not a vector.
    std::erase_if(vectors_, [](const ModelVector& v) {
      return v.has_channel[0] + v.has_channel[1] + v.has_channel[2] < 2;
    });
  }

  // Columns that can be the angle, with their units; only those of the best rank.
  std::vector<AngleMap> angle_choices() {
    std::map<int, std::vector<AngleMap>> by_rank;
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      const auto words = words_of(table_.header[c]);
      const std::string unit = known_unit(table_.units[c]);
      const auto says = [&](std::initializer_list<const char*> list) {
        return std::any_of(list.begin(), list.end(),
                           [&](const char* word) { return contains(words, word); });
      };
      const bool angle = says({"theta", "angle", "phi", "rotation", "deg", "degrees", "winkel",
                               "drehwinkel", "alpha", "rot", "psi", "az"});
      const bool time = says({"time", "t", "zeit", "temps", "tempo", "s", "sec", "ms"});
      const auto add = [&](const std::string& name, int rank) {
        AngleMap map;
        map.column = table_.header[c];
        map.unit = name;
        map.is_time = compare::seconds_per(name) > 0;
        map.degrees_per_unit =
            map.is_time ? compare::seconds_per(name) : compare::degrees_per(name);
        if (is_record(map, c)) by_rank[rank].push_back(map);
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
      throw InputError(table_.file.string() +
                       ": no column can be the shaft's angle or the time of a whole turn: it must "
                       "rise or fall strictly over at least 330 deg");
    return by_rank.begin()->second;
  }

  // Whether a column makes a turn; completes where the turn begins and the rounding.
  bool is_record(AngleMap& map, std::size_t column) const {
    constexpr double kMostTurns = 1000;
    const double scale = map.degrees_per_unit * (map.is_time ? degrees_per_second_ : 1);
    std::vector<double> angles;
    double turns = 0, largest = 0;
    for (const auto& row : table_.rows) {
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
    if (span < kShortestRecord || span > kMostTurns * 360 ||
        span / static_cast<double>(angles.size() - 1) > 30)
      return false;
    const int digits = table_.digits[column];
    if (digits > 0 && digits < 12) {
      // Half a unit of the last digit; but 0, 0.5, 1, .. are exact, which equal steps show.
      double uneven = 0;
      const double step = (angles.back() - angles.front()) / static_cast<double>(angles.size() - 1);
      for (std::size_t i = 0; i < angles.size(); ++i)
        uneven =
            std::max(uneven, std::abs(angles[i] - angles.front() - step * static_cast<double>(i)));
      map.rounding_deg =
          std::min(uneven, std::abs(scale) / 2 *
                               std::pow(10.0, std::floor(std::log10(largest)) - digits + 1));
      if (map.rounding_deg < 1e-9) map.rounding_deg = 0;
    }
    // The last turn of a longer record: by then it has settled.
    const double same = std::max(1e-9, 2 * map.rounding_deg);
    if (span > 360 + same) map.turn_from_deg = rises ? angles.back() - 360 : angles.back();
    return true;
  }

  // Splines through the columns over their own angle.
  void take_turn(const AngleMap& map) {
    const std::size_t angle = column_of(map.column);
    std::vector<double> values;
    for (const auto& row : table_.rows) values.push_back(row[angle]);
    const compare::Turn turn = compare::one_turn(
        table_.file.string(), map, values, [&](std::size_t row) { return table_.place(row); },
        degrees_per_second_);
    time_ = map.is_time;
    splines_.assign(table_.header.size(), std::nullopt);
    ignored_.clear();
    constant_.assign(table_.header.size(), false);
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (c == angle) continue;
      std::vector<double> y;
      for (const auto row : turn.rows) y.push_back(table_.rows[row][c]);
      if (!std::all_of(y.begin(), y.end(), is_computed)) {
        ignored_.emplace_back(table_.header[c], "has empty fields");
        continue;
      }
      // Along the record: time and angles rise or fall all the way, which no periodic curve does.
      double low = y[0], high = y[0];
      bool rises = true, falls = true;
      for (std::size_t i = 1; i < table_.rows.size(); ++i) {
        rises = rises && table_.rows[i][c] > table_.rows[i - 1][c];
        falls = falls && table_.rows[i][c] < table_.rows[i - 1][c];
      }
      for (const double value : y) {
        low = std::min(low, value);
        high = std::max(high, value);
      }
      if (rises || falls) {
        ignored_.emplace_back(table_.header[c], "runs along with the angle");
        continue;
      }
      constant_[c] = high - low <= 1e-9 * std::max(std::abs(low), std::abs(high));
      splines_[c].emplace(turn.theta_deg, y);
    }
    find_groups();
  }

  std::size_t column_of(const std::string& name) const {
    return static_cast<std::size_t>(std::find(table_.header.begin(), table_.header.end(), name) -
                                    table_.header.begin());
  }

  void find_groups() {
    groups_.clear();
    singles_.clear();
    std::map<std::string, Group> by_key;
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (!splines_[c]) continue;
      for (const auto& [key, axis] : axis_readings(table_.header[c])) {
        Group& group = by_key[key];
        group.key = key;
        group.columns[static_cast<std::size_t>(axis)] = c;
        if (group.unit.empty()) group.unit = known_unit(table_.units[c]);
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
        moves = moves || (column && !constant_[*column]);
      }
      if (!free || !moves) continue;
      groups_.push_back(group);
      for (const auto& column : group.columns)
        if (column) taken.insert(*column);
    }
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (!splines_[c] || taken.count(c) > 0) continue;
      if (constant_[c])
        ignored_.emplace_back(table_.header[c], "is constant");
      else if (const auto of = std::find_if(groups_.begin(), groups_.end(),
                                            [&](const Group& g) { return is_length(c, g); });
               of != groups_.end())
        ignored_.emplace_back(table_.header[c], "is the length of " + of->key);
      else
        singles_.push_back(c);
    }
  }

  // Whether a column is the length of a vector of the file.
  bool is_length(std::size_t column, const Group& group) const {
    constexpr double kSame = 1e-4;
    for (const auto& row : table_.rows) {
      double square = 0;
      for (const auto& part : group.columns)
        if (part) square += row[*part] * row[*part];
      if (!(std::abs(std::sqrt(square) - row[column]) <= kSame * std::abs(row[column])))
        return false;
    }
    return true;
  }

  Series sampled(std::size_t column, double sign, double phase, std::size_t count) const {
    Series out;
    for (std::size_t i = 0; i < count; ++i)
      out.push_back((*splines_[column])(
          sign * (360.0 * static_cast<double>(i) / static_cast<double>(count) - phase)));
    return out;
  }

  // The model's curve at the angles of the coarse search.
  Series coarse(const Series& fine) const {
    Series out;
    for (std::size_t i = 0; i < kCoarse; ++i) out.push_back(fine[i * n_ / kCoarse]);
    return out;
  }

  // Components of a vector of the model in the axes of another frame.
  std::array<Series, 3> in_axes(const ModelVector& vector, const std::string& frame) const {
    std::array<Series, 3> out;
    const Axes& to = frames_.at(frame);
    const Axes& from = frames_.at(vector.frame);
    for (std::size_t j = 0; j < 3; ++j) {
      out[j].assign(n_, 0);
      for (std::size_t i = 0; i < 3; ++i) {
        double cosine = 0;
        for (std::size_t l = 0; l < 3; ++l) cosine += to[j][l] * from[i][l];
        for (std::size_t row = 0; row < n_; ++row) out[j][row] += cosine * vector.parts[i][row];
      }
    }
    return out;
  }

  // What the phase is found by: columns about their means, and of whole vectors the length, which
  // no frame changes. Each with the model's curves it may be.
  struct Feature {
    std::vector<std::size_t> columns;
    std::string family;
  };

  std::vector<Found> phases() {
    std::vector<Feature> features;
    const auto family = [](const std::string& unit) {
      const auto* known = compare::find_unit(unit);
      return known == nullptr ? std::string() : known->family;
    };
    for (const Group& group : groups_) {
      if (group.count() == 3) {
        features.push_back(
            {{*group.columns[0], *group.columns[1], *group.columns[2]}, family(group.unit)});
      } else {
        for (const auto& column : group.columns)
          if (column && !constant_[*column]) features.push_back({{*column}, family(group.unit)});
      }
    }
    for (const std::size_t column : singles_)
      features.push_back({{column}, family(known_unit(table_.units[column]))});
    constexpr std::size_t kEnough = 40;
    if (features.size() > kEnough) features.resize(kEnough);

    struct Target {
      Series fine, coarse;
      std::string unit;
      bool length;
    };
    std::vector<Target> targets;
    const auto add = [&](const Series& fine, const std::string& unit, bool length) {
      targets.push_back({normalised(fine), normalised(coarse(fine)), unit, length});
    };
    for (const auto& channel : channels_) add(channel.values, channel.channel.unit, false);
    for (const auto& vector : vectors_) {
      add(length_of(vector.parts), vector.unit, true);
      for (const char* frame : {"S1", "S2"})
        if (vector.frame != frame)
          for (const auto& part : in_axes(vector, frame)) add(part, vector.unit, false);
    }

    const auto series = [&](const Feature& feature, double sign, double phase, std::size_t count) {
      if (feature.columns.size() == 1) return sampled(feature.columns[0], sign, phase, count);
      return length_of({sampled(feature.columns[0], sign, phase, count),
                        sampled(feature.columns[1], sign, phase, count),
                        sampled(feature.columns[2], sign, phase, count)});
    };
    std::vector<Found> result;
    for (const double sign : {1.0, -1.0}) {
      // Cost and best target of each feature by phase.
      std::vector<double> cost(kCoarse, 0);
      std::vector<std::vector<std::size_t>> chosen(kCoarse,
                                                   std::vector<std::size_t>(features.size(), 0));
      for (std::size_t f = 0; f < features.size(); ++f) {
        const Series theirs = normalised(series(features[f], sign, 0, kCoarse));
        std::vector<double> best(kCoarse, 0);
        for (std::size_t t = 0; t < targets.size(); ++t) {
          if (targets[t].length != (features[f].columns.size() == 3)) continue;
          if (!features[f].family.empty() && targets[t].unit != features[f].family) continue;
          const Series& ours = targets[t].coarse;
          for (std::size_t shift = 0; shift < kCoarse; ++shift) {
            // theirs(theta - phase), phase = shift steps
            double r = 0;
            for (std::size_t i = 0; i < shift; ++i) r += ours[i] * theirs[i + kCoarse - shift];
            for (std::size_t i = shift; i < kCoarse; ++i) r += ours[i] * theirs[i - shift];
            const double value = targets[t].length ? (r > 0 ? r * r : 0) : r * r;
            if (value > best[shift]) {
              best[shift] = value;
              chosen[shift][f] = t;
            }
          }
        }
        for (std::size_t shift = 0; shift < kCoarse; ++shift) cost[shift] += 1 - best[shift];
      }
      std::vector<std::size_t> order(kCoarse);
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
      const double pitch = 360.0 / std::max(1, pistons_);
      std::vector<double> tried;
      for (const std::size_t shift : order) {
        const double start = 360.0 * static_cast<double>(shift) / static_cast<double>(kCoarse);
        constexpr std::size_t kTried = 3;
        if (tried.size() >= kTried) break;
        if (std::any_of(tried.begin(), tried.end(), [&](double other) {
              const double apart = std::abs(std::remainder(start - other, pitch));
              return apart < 4;
            }))
          continue;
        tried.push_back(start);
        const auto at = [&](double phase) {
          double sum = 0;
          for (std::size_t f = 0; f < features.size(); ++f) {
            const double r = dot(normalised(series(features[f], sign, phase, n_)),
                                 targets[chosen[shift][f]].fine);
            sum += 1 - r * r;
          }
          return sum;
        };
        Found found;
        found.sign = sign;
        found.phase = least_of(at, start - 3, start + 3);
        found.cost = at(found.phase) / static_cast<double>(features.size());
        if (found.cost < kNoChannel) result.push_back(found);
      }
      if (time_) break;  // the sign of the speed says the direction
    }
    return result;
  }

  // Golden section.
  static double least_of(const std::function<double(double)>& f, double low, double high) {
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    double a = high - ratio * (high - low), b = low + ratio * (high - low);
    double fa = f(a), fb = f(b);
    for (int i = 0; i < 36; ++i) {
      if (fa < fb) {
        high = b;
        b = a;
        fb = fa;
        a = high - ratio * (high - low);
        fa = f(a);
      } else {
        low = a;
        a = b;
        fa = fb;
        b = low + ratio * (high - low);
        fb = f(b);
      }
    }
    return (low + high) / 2;
  }

  // The unit whose factor (theirs over ours, in our unit) is nearest to one that fits.
  std::string unit_for(double fit, const std::string& ours, double unit_in_si,
                       const std::string& said) const {
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

  // Scalar products of a group's columns with a vector's components: enough for every frame.
  struct Products {
    std::array<std::array<double, 3>, 3> theirs_ours{};
    std::array<std::array<double, 3>, 3> ours_ours{};
  };

  // How well a vector in some axes is the group: of both signs the better or the one wanted (0 =
  // either).
  Match match(const Group& group, double square, const Products& p, const Axes& axes,
              const ModelVector& vector, int wanted) const {
    double product = 0, own = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!group.columns[j]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        product += axes[j][i] * p.theirs_ours[j][i];
        for (std::size_t k = 0; k < 3; ++k) own += axes[j][i] * axes[j][k] * p.ours_ours[i][k];
      }
    }
    Match m;
    if (own <= 0 || product == 0) return m;
    m.sign = wanted != 0 ? wanted : product < 0 ? -1 : 1;
    m.unit = unit_for(product / own, vector.unit, vector.unit_in_si, group.unit);
    if (m.unit.empty()) return m;
    const double factor = m.sign * vector.unit_in_si / compare::find_unit(m.unit)->si;
    m.cost =
        std::sqrt(std::max(0.0, square - 2 * factor * product + factor * factor * own) / square);
    return m;
  }

  // The same with the better sign of each component: what is found so has a wrong sign somewhere,
  // and must be compared, not left out.
  double cost_without_signs(const Products& p, const Axes& axes, double factor,
                            const std::array<Series, 3>& theirs) const {
    double difference = 0, square = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      if (theirs[j].empty()) continue;
      double product = 0, own = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        product += axes[j][i] * p.theirs_ours[j][i];
        for (std::size_t k = 0; k < 3; ++k) own += axes[j][i] * axes[j][k] * p.ours_ours[i][k];
      }
      const double theirs_square = dot(theirs[j], theirs[j]);
      difference += theirs_square - 2 * factor * std::abs(product) + factor * factor * own;
      square += theirs_square;
    }
    return std::sqrt(std::max(0.0, difference) / square);
  }

  Axes to_own(const FrameChoice& frame, const ModelVector& vector) const {
    if (frame.axes_of.empty() || frame.axes_of == vector.frame) return frame.axes;
    const Axes& from = frames_.at(frame.axes_of);
    const Axes& to = frames_.at(vector.frame);
    Axes axes{};
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t l = 0; l < 3; ++l)
            axes[j][i] += frame.axes[j][k] * from[k][l] * to[i][l];
    return axes;
  }

  static const std::vector<Axes>& right_angles() {
    static const std::vector<Axes> all = [] {
      std::vector<Axes> list;
      std::array<std::size_t, 3> order = {0, 1, 2};
      do {
        for (int signs = 0; signs < 8; ++signs) {
          Axes axes{};
          for (std::size_t j = 0; j < 3; ++j) axes[j][order[j]] = (signs >> j & 1) != 0 ? -1 : 1;
          const double determinant =
              axes[0][0] * (axes[1][1] * axes[2][2] - axes[1][2] * axes[2][1]) -
              axes[0][1] * (axes[1][0] * axes[2][2] - axes[1][2] * axes[2][0]) +
              axes[0][2] * (axes[1][0] * axes[2][1] - axes[1][1] * axes[2][0]);
          if (determinant > 0) list.push_back(axes);
        }
      } while (std::next_permutation(order.begin(), order.end()));
      return list;
    }();
    return all;
  }

  Assignment assign(double sign, double phase) const {
    Assignment best;
    best.cost = std::numeric_limits<double>::max();
    std::vector<std::array<Series, 3>> theirs;
    std::vector<double> squares;
    std::vector<std::vector<Products>> products(groups_.size());
    std::vector<std::vector<std::size_t>> allowed(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::array<Series, 3> parts;
      double square = 0;
      for (std::size_t j = 0; j < 3; ++j)
        if (groups_[g].columns[j]) {
          parts[j] = sampled(*groups_[g].columns[j], sign, phase, n_);
          square += dot(parts[j], parts[j]);
        }
      const auto words = words_of(groups_[g].key);
      const auto* unit = compare::find_unit(groups_[g].unit);
      for (const bool by_name : {true, false}) {
        if (!allowed[g].empty()) break;
        for (std::size_t v = 0; v < vectors_.size(); ++v)
          if ((unit == nullptr || unit->family == vectors_[v].unit) &&
              (!by_name || is_quantity(words, vectors_[v].quantity)))
            allowed[g].push_back(v);
      }
      products[g].resize(vectors_.size());
      for (const std::size_t v : allowed[g])
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j) {
            if (!parts[j].empty())
              products[g][v].theirs_ours[j][i] = dot(parts[j], vectors_[v].parts[i]);
            products[g][v].ours_ours[j][i] = dot(vectors_[v].parts[j], vectors_[v].parts[i]);
          }
      theirs.push_back(std::move(parts));
      squares.push_back(square);
    }

    const auto try_frame = [&](const FrameChoice& frame) {
      Assignment a;
      a.frame = frame;
      std::map<std::string, std::array<double, 2>> by_sign;  // quantity -> cost of +, -
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        Match found;
        for (const std::size_t v : allowed[g]) {
          Match m = match(groups_[g], squares[g], products[g][v], to_own(frame, vectors_[v]),
                          vectors_[v], 0);
          m.index = v;
          if (m.cost < found.cost) found = m;
        }
        a.groups.push_back(found);
      }
      renumber(a);
      // One sign per quantity.
      for (const int pass : {0, 1})
        for (std::size_t g = 0; g < groups_.size(); ++g) {
          Match& m = a.groups[g];
          if (!m.found()) continue;
          const ModelVector& vector = vectors_[m.index];
          auto& costs = by_sign[vector.quantity];
          const auto with = [&](int wanted) {
            Match out = match(groups_[g], squares[g], products[g][m.index], to_own(frame, vector),
                              vector, wanted);
            out.index = m.index;
            return out;
          };
          if (pass == 0) {
            costs[0] += std::min(with(1).cost, 2.0);
            costs[1] += std::min(with(-1).cost, 2.0);
          } else {
            // A turned frame and a reversal both, shown by a single vector, would also be the error
            // of one sign.
            const bool reversal = groups_.size() > 1 || frame.plain();
            m = with(reversal && costs[1] < costs[0] ? -1 : 1);
          }
        }
      for (const Match& m : a.groups) a.cost += std::min(m.cost, 1.0);
      // Of frames that fit as well the plainest, which come first.
      if (a.cost < best.cost * (1 - 1e-6) - 1e-9) best = std::move(a);
    };
    if (groups_.empty()) {
      try_frame({});
    } else {
      for (const char* base : {"", "S1", "S2"}) try_frame({base, compare::kNoTurn, "", {}});
      for (const char* base : {"", "S1", "S2"})
        for (const Axes& axes : right_angles()) try_frame({base, axes, "", {}});
      const bool whole = std::any_of(groups_.begin(), groups_.end(),
                                     [](const Group& g) { return g.count() == 3; });
      if (whole && best.cost > kPoorFrame * static_cast<double>(groups_.size()))
        turn_by_euler_angles(products, allowed, theirs, try_frame);
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (best.groups[g].cost < kNoChannel) continue;
      constexpr double kSameButSigns = 0.3;
      double least = kSameButSigns;
      const int piston = best.groups[g].found() && piston_in(groups_[g].key, pistons_) > 0
                             ? vectors_[best.groups[g].index].piston
                             : 0;  // set by the numbering
      for (const std::size_t v : allowed[g]) {
        if (piston > 0 && vectors_[v].piston != piston) continue;
        const Axes axes = to_own(best.frame, vectors_[v]);
        double own = 0;
        for (std::size_t i = 0; i < 3; ++i) own += products[g][v].ours_ours[i][i];
        Match m;
        m.index = v;
        m.unit = own > 0 ? unit_for(std::sqrt(squares[g] / own), vectors_[v].unit,
                                    vectors_[v].unit_in_si, groups_[g].unit)
                         : "";
        if (m.unit.empty()) continue;
        const double factor = vectors_[v].unit_in_si / compare::find_unit(m.unit)->si;
        const double cost = cost_without_signs(products[g][v], axes, factor, theirs[g]);
        if (cost >= least) continue;
        least = cost;
        m.cost = 1;
        m.signs_differ = true;
        for (std::size_t other = 0; other < groups_.size(); ++other)
          if (other != g && best.groups[other].found() && !best.groups[other].signs_differ &&
              vectors_[best.groups[other].index].quantity == vectors_[v].quantity)
            m.sign = best.groups[other].sign;
        best.groups[g] = m;
      }
    }
    assign_columns(best, sign, phase);
    return best;
  }

  // Frames at whole multiples of 5 deg: the best of them for the vectors whose length says which
  // they are.
  template <class Try>
  void turn_by_euler_angles(const std::vector<std::vector<Products>>& products,
                            const std::vector<std::vector<std::size_t>>& allowed,
                            const std::vector<std::array<Series, 3>>& theirs,
                            const Try& try_frame) const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // group, vector
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].count() != 3) continue;
      const Series length = length_of(theirs[g]);
      double best = -2;
      std::size_t which = 0;
      for (const std::size_t v : allowed[g]) {
        const Series ours = length_of(vectors_[v].parts);
        const double r =
            dot(length, ours) / std::sqrt(dot(length, length) * dot(ours, ours) + 1e-300);
        if (r > best) {
          best = r;
          which = v;
        }
      }
      if (best > 0) pairs.emplace_back(g, which);
    }
    for (const char* base : {"", "S1", "S2"}) {
      // Per quantity, the sum over vectors of <theirs_j, ours_i> in the axes of the base, each over
      // its own size: the frame whose traces with them are largest, whatever their signs, is the
      // best.
      std::map<std::string, Axes> sums;
      for (const auto& [g, v] : pairs) {
        Axes& sum = sums[vectors_[v].quantity];
        const Axes plain = to_own({base, compare::kNoTurn, "", {}}, vectors_[v]);
        double size = 0;
        for (std::size_t i = 0; i < 3; ++i) size += products[g][v].ours_ours[i][i];
        size = std::sqrt(size * dot(theirs[g][0], theirs[g][0]) +
                         size * dot(theirs[g][1], theirs[g][1]) +
                         size * dot(theirs[g][2], theirs[g][2]));
        for (std::size_t j = 0; j < 3; ++j)
          for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i)
              sum[j][k] += products[g][v].theirs_ours[j][i] * plain[k][i] / size;
      }
      for (const char* sequence : {"ZXZ", "XYZ"}) {
        FrameChoice best;
        double most = -1;
        for (int a = 0; a < 360; a += kEulerStep)
          for (int b = 0; b <= 180; b += kEulerStep)
            for (int c = 0; c < 360; c += kEulerStep) {
              const Axes axes = turned(sequence, a, b, c);
              double total = 0;
              for (const auto& [quantity, sum] : sums) {
                double trace = 0;
                for (std::size_t j = 0; j < 3; ++j)
                  for (std::size_t k = 0; k < 3; ++k) trace += axes[j][k] * sum[j][k];
                total += std::abs(trace);
              }
              if (total > most + 1e-12) {
                most = total;
                best = {base, axes, sequence, {double(a), double(b), double(c)}};
              }
            }
        try_frame(best);
      }
    }
  }

  // compare::turned_axes with its sines looked up.
  static Axes turned(const char* sequence, int a, int b, int c) {
    static const auto table = [] {
      std::array<std::pair<double, double>, 360> t;
      for (int i = 0; i < 360; ++i)
        t[static_cast<std::size_t>(i)] = {std::cos(radians(i)), std::sin(radians(i))};
      return t;
    }();
    Axes axes = compare::kNoTurn;
    const int angles[] = {a, b, c};
    for (int turn = 0; turn < 3; ++turn) {
      const auto axis = static_cast<std::size_t>(sequence[turn] - 'X');
      const std::size_t p = (axis + 1) % 3, q = (axis + 2) % 3;
      const auto [cosine, sine] = table[static_cast<std::size_t>(angles[turn])];
      const auto first = axes[p], second = axes[q];
      for (std::size_t i = 0; i < 3; ++i) {
        axes[p][i] = cosine * first[i] + sine * second[i];
        axes[q][i] = cosine * second[i] - sine * first[i];
      }
    }
    return axes;
  }

  // One numbering of the pistons for the file: number in the name = first + direction x ours. What
  // does not follow it is set right, so that pistons which were mixed up stay so.
  void renumber(Assignment& a) const {
    struct Vote {
      std::size_t group;
      int said, found;
    };
    std::vector<Vote> votes;
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (a.groups[g].found() && vectors_[a.groups[g].index].piston > 0)
        if (const int said = piston_in(groups_[g].key, pistons_); said > 0)
          votes.push_back({g, said, vectors_[a.groups[g].index].piston});
    if (votes.empty()) return;
    const auto numbering = best_numbering(votes);
    for (const Vote& vote : votes) {
      const int wanted = numbering(vote.said);
      a.numbered += wanted == vote.said;
      if (wanted == vote.found) continue;
      const ModelVector& now = vectors_[a.groups[vote.group].index];
      for (std::size_t v = 0; v < vectors_.size(); ++v)
        if (vectors_[v].quantity == now.quantity && vectors_[v].piston == wanted) {
          a.groups[vote.group].index = v;
          break;
        }
    }
  }

  template <class Votes>
  std::function<int(int)> best_numbering(const Votes& votes) const {
    // Numbered against the rotation: only where enough pistons show it, for of two or three it
    // could be that two were mixed up.
    constexpr std::size_t kShowReversal = 4;
    std::set<int> different;
    for (const auto& vote : votes) different.insert(vote.said);
    int most = -1, first = 0, direction = 1;
    for (const int d : {1, -1})
      for (int m = 0; m < pistons_; ++m) {
        int count = 0;
        for (const auto& vote : votes)
          count += (d * (vote.said - 1) + m + pistons_) % pistons_ + 1 == vote.found;
        if (count > most && (d > 0 || different.size() >= kShowReversal)) {
          most = count;
          first = m;
          direction = d;
        }
      }
    return
        [=, this](int said) { return (direction * (said - 1) + first + pistons_) % pistons_ + 1; };
  }

  // Columns that belong to no vector: each one channel.
  void assign_columns(Assignment& a, double sign, double phase) const {
    std::map<std::string, int> signs;  // of quantities that vectors have
    for (const Match& m : a.groups)
      if (m.found()) signs[vectors_[m.index].quantity] = m.sign;
    struct Vote {
      std::size_t column;
      int said, found;
    };
    std::vector<Vote> votes;
    std::vector<Series> curves;
    const auto match_channel = [&](const Series& theirs, std::size_t channel, std::size_t column,
                                   int wanted) {
      const ModelChannel& ours = channels_[channel];
      const double product = dot(theirs, ours.values), own = dot(ours.values, ours.values);
      const double square = dot(theirs, theirs);
      Match m;
      m.index = channel;
      if (own <= 0 || product == 0) return m;
      m.sign = wanted != 0 ? wanted : product < 0 ? -1 : 1;
      m.unit = unit_for(product / own, ours.channel.unit, ours.channel.unit_in_si,
                        known_unit(table_.units[column]));
      if (m.unit.empty()) return m;
      const double factor = m.sign * ours.channel.unit_in_si / compare::find_unit(m.unit)->si;
      m.cost =
          std::sqrt(std::max(0.0, square - 2 * factor * product + factor * factor * own) / square);
      return m;
    };
    for (const std::size_t column : singles_) {
      curves.push_back(sampled(column, sign, phase, n_));
      const auto words = words_of(table_.header[column]);
      const auto* unit = compare::find_unit(known_unit(table_.units[column]));
      Match found;
      for (const bool by_name : {true, false}) {
        if (found.found()) break;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
          const Channel& channel = channels_[c].channel;
          if (unit != nullptr && unit->family != channel.unit) continue;
          if (by_name && !named(words, channel)) continue;
          // A pressure pushes; it has no other body to be seen from.
          const Match m =
              match_channel(curves.back(), c, column, channel.kind == ChannelKind::input ? 1 : 0);
          if (m.cost < found.cost) found = m;
        }
      }
      a.columns.push_back(found);
      if (found.found() && channels_[found.index].channel.piston > 0)
        if (const int said = piston_in(table_.header[column], pistons_); said > 0)
          votes.push_back({a.columns.size() - 1, said, channels_[found.index].channel.piston});
    }
    if (!votes.empty()) {
      const auto numbering = best_numbering(votes);
      for (const Vote& vote : votes) {
        const int wanted = numbering(vote.said);
        a.numbered += wanted == vote.said;
        if (wanted == vote.found) continue;
        const Channel& now = channels_[a.columns[vote.column].index].channel;
        for (std::size_t c = 0; c < channels_.size(); ++c)
          if (channels_[c].channel.quantity == now.quantity &&
              channels_[c].channel.axis == now.axis && channels_[c].channel.piston == wanted)
            a.columns[vote.column].index = c;
      }
    }
    // One sign per quantity.
    std::map<std::string, std::array<double, 2>> by_sign;
    for (const int pass : {0, 1})
      for (std::size_t i = 0; i < singles_.size(); ++i) {
        Match& m = a.columns[i];
        if (!m.found()) continue;
        const Channel& channel = channels_[m.index].channel;
        const auto fixed = signs.find(channel.quantity);
        if (pass == 0) {
          for (const int s : {0, 1})
            by_sign[channel.quantity][s] +=
                std::min(2.0, match_channel(curves[i], m.index, singles_[i], s == 0 ? 1 : -1).cost);
          continue;
        }
        const auto& costs = by_sign[channel.quantity];
        const int wanted = channel.kind == ChannelKind::input ? 1
                           : fixed != signs.end()             ? fixed->second
                           : costs[1] < costs[0]              ? -1
                                                              : 1;
        m = match_channel(curves[i], m.index, singles_[i], wanted);
      }
    for (const Match& m : a.columns) a.cost += std::min(m.cost, 1.0);
  }

  // Whether the words of a column's name are those of a channel: quantity, piston, axis.
  bool named(const std::vector<std::string>& words, const Channel& channel) const {
    if (channel.quantity == "Td" && contains(words, "torque")) return true;
    auto needed = words_of(channel.name);
    needed.pop_back();  // the unit may differ
    return std::all_of(needed.begin(), needed.end(),
                       [&](const auto& word) { return contains(words, word); });
  }

  MappingGuess finish(const Found& found);

  const ForeignTable& table_;
  const compare::FrameAxes& frames_;
  double degrees_per_second_;
  std::size_t n_;
  int pistons_ = 0;
  bool time_ = false;
  std::vector<ModelVector> vectors_;
  std::vector<ModelChannel> channels_;
  std::vector<std::optional<PeriodicSpline>> splines_;
  std::vector<bool> constant_;
  std::vector<Group> groups_;
  std::vector<std::size_t> singles_;
  std::vector<std::pair<std::string, std::string>> ignored_;
};

// What is compared in the end, per group or column: theirs against ours, mapped to theirs.
struct Pairing {
  std::string theirs, ours, unit;
  int sign = 1;
  std::vector<std::size_t> columns;
  std::vector<Series> curves;  // of the model, in their unit, sign and axes
};

// The roundest of the angles near `best` that cost as little.
double roundest(const std::function<double(double)>& cost, double best) {
  constexpr double kAsGood = 0.2;  // of the logarithm of the mean square difference
  const double least = cost(best);
  for (const double step : {90.0, 45.0, 30.0, 10.0, 5.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.01, 0.005,
                            1e-3, 1e-4, 1e-5, 1e-6}) {
    const double round = std::round(best / step) * step;
    if (std::abs(round - best) < 2 && cost(round) <= least + kAsGood) return round;
  }
  return best;
}

MappingGuess Guesser::finish(const Found& found) {
  // Another piston's angle is the same turn: the numbers in the names say which, else the smallest
  // shift.
  const double pitch = 360.0 / std::max(1, pistons_);
  std::vector<std::pair<double, Assignment>> variants;
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < std::max(1, pistons_); ++i) {
    double phase = std::remainder(found.phase + i * pitch, 360.0);
    if (std::abs(phase) > 180 - 1e-6) phase = 180;
    variants.emplace_back(phase, assign(found.sign, phase));
    least = std::min(least, variants.back().second.cost);
  }
  const auto* best = &variants.front();
  const auto worth = [&](const std::pair<double, Assignment>& v) {
    return std::tuple(v.second.cost > 1.02 * least + 1e-4, -v.second.numbered,
                      std::round(std::abs(v.first) * 1e3));
  };
  for (const auto& variant : variants)
    if (worth(variant) < worth(*best)) best = &variant;
  double phase = best->first;
  const Assignment& a = best->second;

  MappingGuess guess;
  guess.ignored = ignored_;
  compare::CurveDescription& curve = guess.curve;
  curve.file = table_.file;
  curve.sheet = table_.sheet;
  curve.points = static_cast<int>(table_.rows.size());
  curve.models = {"analytic", "multibody"};
  curve.guessed = true;
  std::vector<Pairing> pairings;
  int most_digits = 0;
  for (const int digits : table_.digits) most_digits = std::max(most_digits, digits);
  const auto rounding = [&](std::size_t column, double in_our_unit, double peak) {
    double largest = 0;
    for (const auto& row : table_.rows)
      if (is_computed(row[column])) largest = std::max(largest, std::abs(row[column]));
    const int digits = table_.digits[column] > 0 ? table_.digits[column] : most_digits;
    if (digits > 0) guess.digits = guess.digits == 0 ? digits : std::min(guess.digits, digits);
    if (largest == 0 || digits == 0 || peak == 0) return;
    const double half = std::pow(10.0, std::floor(std::log10(largest)) - digits + 1) / 2;
    guess.rounding = std::max(guess.rounding, half * in_our_unit / peak);
  };
  const auto ignore = [&](std::size_t column, const std::string& why) {
    guess.ignored.emplace_back(table_.header[column], why);
  };

  const bool own_plain = a.frame.axes_of.empty() && a.frame.plain();
  std::set<std::string> taken;
  bool uses_frame = false;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const Match& m = a.groups[g];
    // Its name says the quantity, or which of the pistons it is.
    const bool by_name =
        m.found() && (is_quantity(words_of(group.key), vectors_[m.index].quantity) ||
                      (vectors_[m.index].piston > 0 && piston_in(group.key, pistons_) > 0));
    const bool fits =
        m.found() && (m.cost < kNoChannel || m.signs_differ || (by_name && m.cost < 2.5));
    if (!fits || !taken.insert(vectors_[m.index].ours).second) {
      for (const auto& column : group.columns)
        if (column)
          ignore(*column, fits ? "like another column, looks like " + vectors_[m.index].ours
                               : "no channel has this curve");
      continue;
    }
    const ModelVector& vector = vectors_[m.index];
    const double unit = compare::find_unit(m.unit)->si;
    const double factor = m.sign * vector.unit_in_si / unit;
    const Axes axes = to_own(a.frame, vector);
    Pairing pairing{"", vector.ours, m.unit, m.sign, {}, {}};
    compare::VectorMap map;
    map.ours = vector.ours;
    map.unit = m.unit;
    map.unit_in_si = unit;
    map.factor = m.sign;
    bool simple = own_plain;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!group.columns[j]) continue;
      const std::size_t column = *group.columns[j];
      map.theirs[j] = table_.header[column];
      pairing.theirs += (pairing.theirs.empty() ? "" : ", ") + table_.header[column];
      pairing.columns.push_back(column);
      Series ours(n_, 0);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t row = 0; row < n_; ++row)
          ours[row] += factor * axes[j][i] * vector.parts[i][row];
      pairing.curves.push_back(std::move(ours));
      rounding(column, unit / vector.unit_in_si, vector.peak);
      simple = simple && vector.has_channel[j];
    }
    pairings.push_back(std::move(pairing));
    if (simple) {
      for (std::size_t j = 0; j < 3; ++j)
        if (group.columns[j])
          curve.columns.push_back({map.theirs[j], vector.names[j], m.unit, unit, double(m.sign)});
      for (std::size_t j = 0; j < 3; ++j)
        if (group.columns[j]) taken.insert(vector.names[j]);
    } else {
      uses_frame = true;
      for (const auto& name : vector.names) taken.insert(name);
      curve.vectors.push_back(std::move(map));
    }
  }
  for (std::size_t i = 0; i < singles_.size(); ++i) {
    const Match& m = a.columns[i];
    const std::size_t column = singles_[i];
    const bool by_name =
        m.found() && named(words_of(table_.header[column]), channels_[m.index].channel);
    const bool fits = m.found() && (m.cost < kNoChannel || (by_name && m.cost < 2.5));
    if (!fits || !taken.insert(channels_[m.index].channel.name).second) {
      ignore(column, fits ? "like another column, looks like " + channels_[m.index].channel.name
                          : "no channel has this curve");
      continue;
    }
    const ModelChannel& ours = channels_[m.index];
    const double unit = compare::find_unit(m.unit)->si;
    Pairing pairing{table_.header[column], ours.channel.name, m.unit, m.sign, {column}, {}};
    Series values = ours.values;
    for (double& value : values) value *= m.sign * ours.channel.unit_in_si / unit;
    pairing.curves.push_back(std::move(values));
    pairings.push_back(std::move(pairing));
    curve.columns.push_back(
        {table_.header[column], ours.channel.name, m.unit, unit, double(m.sign)});
    rounding(column, unit / ours.channel.unit_in_si, ours.peak);
  }
  if (pairings.empty())
    throw InputError(table_.file.string() +
                     ": no column follows any of the model's curves; is it of this case?");

  // The phase: the best one, then the roundest that is as good. By logarithms, so that the curves
  // which fit decide and not the one that does not.
  const auto cost = [&](double at) {
    double sum = 0;
    for (const Pairing& pairing : pairings) {
      double difference = 0, square = 0;
      for (std::size_t k = 0; k < pairing.columns.size(); ++k) {
        const Series theirs = sampled(pairing.columns[k], found.sign, at, n_);
        for (std::size_t row = 0; row < n_; ++row) {
          difference += std::pow(theirs[row] - pairing.curves[k][row], 2);
          square += theirs[row] * theirs[row];
        }
      }
      constexpr double kRoundOff = 1e-24;
      if (square > 0) sum += std::log(kRoundOff + difference / square);
    }
    return sum / static_cast<double>(pairings.size());
  };
  phase = roundest(cost, least_of(cost, phase - 0.5, phase + 0.5));
  for (const Pairing& pairing : pairings) {
    MappingProposal proposal{pairing.theirs, pairing.ours, pairing.sign, pairing.unit, 0, 0, ""};
    double product = 0, theirs_square = 0, ours_square = 0, difference = 0, square = 0;
    for (std::size_t k = 0; k < pairing.columns.size(); ++k) {
      const Series theirs = sampled(pairing.columns[k], found.sign, phase, n_);
      for (std::size_t row = 0; row < n_; ++row) {
        difference += std::pow(theirs[row] - pairing.curves[k][row], 2);
        square += theirs[row] * theirs[row];
      }
      const Series x = centred(theirs), y = centred(pairing.curves[k]);
      product += dot(x, y);
      theirs_square += dot(x, x);
      ours_square += dot(y, y);
      const std::string& unit = table_.units[pairing.columns[k]];
      if (!unit.empty() && !known_unit(unit).empty() && known_unit(unit) != pairing.unit &&
          proposal.remark.empty())
        proposal.remark = "the file says " + unit;
    }
    proposal.correlation =
        theirs_square > 0 && ours_square > 0 ? product / std::sqrt(theirs_square * ours_square) : 0;
    proposal.difference = square > 0 ? std::sqrt(difference / square) : 0;
    if (proposal.difference > kNoChannel)
      proposal.remark = pairing.columns.size() > 1
                            ? "differs by its signs, or only its name says so"
                            : "its name says so, its curve does not";
    guess.proposals.push_back(std::move(proposal));
  }
  std::stable_sort(guess.proposals.begin(), guess.proposals.end(),
                   [](const auto& x, const auto& y) { return x.difference > y.difference; });
  for (const auto& [column, why] : guess.ignored) curve.ignored.push_back(column);

  curve.angle = found.angle;
  curve.angle.sign = found.sign;
  curve.angle.offset_deg = phase;
  if (curve.angle.turn_from_deg)
    *curve.angle.turn_from_deg =
        phase + (found.sign > 0 ? *curve.angle.turn_from_deg : -*curve.angle.turn_from_deg - 360);
  // Angles that a run of as many samples has: then nothing need be resampled.
  const std::size_t angle = column_of(curve.angle.column);
  std::vector<double> values;
  for (const auto& row : table_.rows) values.push_back(row[angle]);
  const compare::Turn turn = compare::one_turn(
      table_.file.string(), curve.angle, values, [&](std::size_t row) { return table_.place(row); },
      degrees_per_second_);
  const double step = 360.0 / static_cast<double>(turn.rows.size());
  const double same = std::max(1e-9, curve.angle.rounding_deg);
  if (same < step / 10 && std::all_of(turn.theta_deg.begin(), turn.theta_deg.end(), [&](double at) {
        return std::abs(std::remainder(at, step)) <= same;
      }))
    guess.samples = static_cast<int>(turn.rows.size());
  if (uses_frame) {
    curve.frame.axes_of = a.frame.axes_of;
    curve.frame.cosines = a.frame.axes;
    curve.frame.words =
        a.frame.axes_of.empty() ? "the axes of each reaction" : "the axes of " + a.frame.axes_of;
    if (!a.frame.euler.empty())
      curve.frame.words +=
          fmt::format(", turned by {:g}, {:g}, {:g} deg about {}", a.frame.angles[0],
                      a.frame.angles[1], a.frame.angles[2], a.frame.euler);
    else if (!a.frame.plain())
      curve.frame.words += ", exchanged";
    guess.euler = a.frame.euler;
    guess.euler_deg = a.frame.angles;
  }
  return guess;
}

}  // namespace

std::size_t MappingGuess::recognised() const {
  std::size_t count = curve.columns.size();
  for (const auto& vector : curve.vectors)
    count +=
        3 - static_cast<std::size_t>(std::count(vector.theirs.begin(), vector.theirs.end(), ""));
  return count;
}

MappingGuess guess_mapping(const ForeignTable& table, const ResultTable& model,
                           const compare::FrameAxes& frames, double degrees_per_second) {
  return Guesser(table, model, frames, degrees_per_second).guess();
}

}  // namespace bentaxis::study

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
#include "mapping_guess_pieces.h"

namespace bentaxis::study {
namespace mapping {
namespace {

// Frames at right angles that leave more than this are held against frames at Euler angles.
constexpr double kPoorFrame = 0.02;

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

struct FrameChoice {
  std::string axes_of;
  Axes axes = compare::kNoTurn;
  std::string euler;  // sequence, where it was turned by such angles
  std::array<double, 3> angles{};
  bool plain() const { return axes == compare::kNoTurn; }
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
    const auto choices = angle_choices(table_, degrees_per_second_);
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
    std::vector<bool> has_curve(table_.header.size(), false);
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (c == angle) continue;
      std::vector<double> y;
      for (const auto row : turn.rows) y.push_back(table_.rows[row][c]);
      if (!std::all_of(y.begin(), y.end(), is_computed)) {
        ignored_.emplace_back(table_.header[c], "has empty fields");
        continue;
      }
      if (runs_along(table_, c)) {
        ignored_.emplace_back(table_.header[c], "runs along with the angle");
        continue;
      }
      has_curve[c] = true;
      constant_[c] = is_constant(y);
      splines_[c].emplace(turn.theta_deg, y);
    }
    Grouping found = find_groups(table_, has_curve, constant_);
    groups_ = std::move(found.groups);
    singles_ = std::move(found.singles);
    ignored_.insert(ignored_.end(), found.ignored.begin(), found.ignored.end());
  }

  std::size_t column_of(const std::string& name) const {
    return static_cast<std::size_t>(std::find(table_.header.begin(), table_.header.end(), name) -
                                    table_.header.begin());
  }

  Series sampled(std::size_t column, double sign, double phase, std::size_t count) const {
    Series out;
    for (std::size_t i = 0; i < count; ++i)
      out.push_back((*splines_[column])(
          sign * (360.0 * static_cast<double>(i) / static_cast<double>(count) - phase)));
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
          for (const auto& part :
               in_axes(vector.parts, frames_.at(vector.frame), frames_.at(frame)))
            add(part, vector.unit, false);
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
            const double r = shifted_product(ours, theirs, shift);
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

  // How well a vector in some axes is the group: of both signs the better or the one wanted (0 =
  // either).
  static Match match(const Group& group, double square, const Products& p, const Axes& axes,
                     const ModelVector& vector, int wanted) {
    double product = 0, own = 0;
    for (std::size_t j = 0; j < 3; ++j)
      if (group.columns[j]) add_component(p, axes, j, product, own);
    return match_of(square, product, own, vector.unit, vector.unit_in_si, group.unit, wanted);
  }

  Axes to_own(const FrameChoice& frame, const ModelVector& vector) const {
    if (frame.axes_of.empty() || frame.axes_of == vector.frame) return frame.axes;
    return carried(frame.axes, frames_.at(frame.axes_of), frames_.at(vector.frame));
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
    const auto numbering = best_numbering(numbers_of(votes), pistons_);
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
  static std::vector<std::pair<int, int>> numbers_of(const Votes& votes) {
    std::vector<std::pair<int, int>> numbers;
    for (const auto& vote : votes) numbers.emplace_back(vote.said, vote.found);
    return numbers;
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
      Match m = match_of(square, product, own, ours.channel.unit, ours.channel.unit_in_si,
                         known_unit(table_.units[column]), wanted);
      m.index = channel;
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
      const auto numbering = best_numbering(numbers_of(votes), pistons_);
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

// Takes what is proposed for some columns out of a guess: their curves are not those of the
// channel.
void leave_out(MappingGuess& guess, const std::vector<std::string>& columns,
               const std::string& ours, double correlation) {
  const auto theirs = [&](const std::string& name) {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  };
  std::erase_if(guess.curve.columns, [&](const auto& column) { return theirs(column.theirs); });
  std::erase_if(guess.curve.vectors, [&](const auto& vector) {
    return std::any_of(vector.theirs.begin(), vector.theirs.end(), theirs);
  });
  for (const std::string& column : columns) {
    guess.ignored.emplace_back(
        column,
        fmt::format("not recognised: looks like {}, but the correlation is {:.2f}, less than {:g}",
                    ours, correlation, kLeastCorrelation));
    guess.unrecognised.push_back(column);
  }
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
    guess.rounding =
        std::max(guess.rounding, half_of_last_digit(largest, digits) * in_our_unit / peak);
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
    double without_signs = 0;
    bool ours_constant = true;  // then nothing but its value says what it is
    for (std::size_t k = 0; k < pairing.columns.size(); ++k) {
      const Series theirs = sampled(pairing.columns[k], found.sign, phase, n_);
      for (std::size_t row = 0; row < n_; ++row) {
        difference += std::pow(theirs[row] - pairing.curves[k][row], 2);
        square += theirs[row] * theirs[row];
      }
      const Series x = centred(theirs), y = centred(pairing.curves[k]);
      product += dot(x, y);
      without_signs += std::abs(dot(x, y));
      ours_constant = ours_constant && is_constant(pairing.curves[k]);
      theirs_square += dot(x, x);
      ours_square += dot(y, y);
      const std::string& unit = table_.units[pairing.columns[k]];
      if (!unit.empty() && !known_unit(unit).empty() && known_unit(unit) != pairing.unit &&
          proposal.remark.empty())
        proposal.remark = "the file says " + unit;
    }
    const double scale = std::sqrt(theirs_square * ours_square);
    proposal.correlation = scale > 0 ? product / scale : 0;
    const double followed =
        pairing.columns.size() > 1 && scale > 0 ? without_signs / scale : proposal.correlation;
    proposal.difference = square > 0 ? std::sqrt(difference / square) : 0;
    if (proposal.difference > kNoChannel)
      proposal.remark = pairing.columns.size() > 1
                            ? "differs by its signs, or only its name says so"
                            : "its name says so, its curve does not";
    if (!ours_constant && !(followed >= kLeastCorrelation)) {
      std::vector<std::string> columns;
      for (const std::size_t column : pairing.columns) columns.push_back(table_.header[column]);
      leave_out(guess, columns, pairing.ours, proposal.correlation);
      continue;
    }
    guess.proposals.push_back(std::move(proposal));
  }
  if (guess.proposals.empty())
    throw InputError(table_.file.string() +
                     ": no column follows any of the model's curves with a "
                     "correlation of at least " +
                     number_text(kLeastCorrelation) + "; is it of this case?");
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
}  // namespace mapping

std::size_t MappingGuess::recognised() const {
  std::size_t count = curve.columns.size();
  for (const auto& vector : curve.vectors)
    count +=
        3 - static_cast<std::size_t>(std::count(vector.theirs.begin(), vector.theirs.end(), ""));
  return count;
}

MappingGuess guess_mapping(const ForeignTable& table, const ResultTable& model,
                           const compare::FrameAxes& frames, double degrees_per_second) {
  return mapping::Guesser(table, model, frames, degrees_per_second).guess();
}

}  // namespace bentaxis::study

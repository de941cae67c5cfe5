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

#include "bentaxis/numerics/minimum.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "mapping_guess_pieces.h"

namespace bentaxis::study {
namespace mapping {
namespace {

// Frames at right angles that leave more than this are compared with frames at any angle.
constexpr double kPoorFrame = 0.02;
// A frame nearer than this to one at right angles is that frame: the angle between them is an error
// of the record or of the model, and must be seen.
constexpr double kSameFrame = 5;  // deg

// Of two frames the one whose score is smaller by less than this fits as well.
constexpr double kBetter = 1e-6;

struct ModelVector {
  Channel channel;  // of its components, without an axis
  double peak = 0;
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
  double cost = 0;   // sum over groups and columns
  double score = 0;  // of the groups, by which frames are chosen: the smaller the better
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
        // A curve that is the same both ways turns forwards: round-off must not decide.
        constexpr double kTie = 1e-3;
        const double ahead = !best ? 0 : (best->sign - found.sign) / 2 * kTie;
        if (!best || found.score < least - ahead) {
          least = found.score;
          best = found;
          best->angle = choice;
        }
      }
    }
    if (!best)
      throw InputError(table_.file.string() +
                       ": no column resembles a curve of the model; is it a record of this case?");
    take_turn(best->angle);
    return finish(*best);
  }

 private:
  struct Found {
    AngleMap angle;
    double sign = 1, phase = 0;
    double cost = 0;   // mean over the features
    double score = 0;  // by which phases are chosen: the smaller the better
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
        vectors_.push_back({channel, one.peak, {}, {}, {}});
        vectors_.back().channel.name = name;
        vectors_.back().channel.axis.clear();
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
    undecided_.clear();
    constant_.assign(table_.header.size(), false);
    std::vector<bool> has_curve(table_.header.size(), false);
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (c == angle) continue;
      std::vector<double> y;
      for (const auto row : turn.rows) y.push_back(table_.rows[row][c]);
      if (const auto empty =
              std::count_if(y.begin(), y.end(), [](double value) { return !is_computed(value); });
          empty > 0) {
        // A column that is mostly there is one that somebody wants compared.
        const bool wanted = 2 * static_cast<std::size_t>(empty) < y.size();
        ignored_.emplace_back(table_.header[c],
                              fmt::format("{}has empty fields: {} of {}",
                                          wanted ? "not recognised: " : "", empty, y.size()));
        if (wanted) undecided_.push_back(table_.header[c]);
        continue;
      }
      if (runs_along(table_, c)) {
        ignored_.emplace_back(table_.header[c], "is proportional to the angle");
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

  // Of a column's heading, where it is another one than the values fit; "" = none.
  std::string contradicting_unit(std::size_t column, const std::string& unit) const {
    const std::string& said = table_.units[column];
    return known_unit(said).empty() || known_unit(said) == unit ? "" : said;
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
      add(length_of(vector.parts), vector.channel.unit, true);
      for (const char* frame : {"S1", "S2"})
        if (vector.channel.frame != frame)
          for (const auto& part :
               in_axes(vector.parts, frames_.at(vector.channel.frame), frames_.at(frame)))
            add(part, vector.channel.unit, false);
    }

    const auto series = [&](const Feature& feature, double sign, double phase, std::size_t count) {
      if (feature.columns.size() == 1) return sampled(feature.columns[0], sign, phase, count);
      return length_of({sampled(feature.columns[0], sign, phase, count),
                        sampled(feature.columns[1], sign, phase, count),
                        sampled(feature.columns[2], sign, phase, count)});
    };
    // By logarithms, so that the curves which fit decide and not the one that lags.
    const auto of_feature = [](double square) {
      constexpr double kAsGoodAsExact = 1e-4;
      return std::log(kAsGoodAsExact + std::max(0.0, 1 - square));
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
        for (std::size_t shift = 0; shift < kCoarse; ++shift)
          cost[shift] += of_feature(best[shift]);
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
        const auto at = [&](double phase, const auto& of_square) {
          double sum = 0;
          for (std::size_t f = 0; f < features.size(); ++f) {
            const double r = dot(normalised(series(features[f], sign, phase, n_)),
                                 targets[chosen[shift][f]].fine);
            sum += of_square(r * r);
          }
          return sum / static_cast<double>(features.size());
        };
        Found found;
        found.sign = sign;
        found.phase =
            start + numerics::smallest_at(
                        [&](double moved) { return at(start + moved, of_feature); }, -3, 3);
        found.cost = at(found.phase, [](double square) { return 1 - square; });
        found.score = at(found.phase, of_feature);
        if (found.cost < kNoChannel) result.push_back(found);
      }
      if (time_) break;  // the sign of the speed says the direction
    }
    return result;
  }

  Axes to_own(const FrameChoice& frame, const ModelVector& vector) const {
    if (frame.axes_of.empty() || frame.axes_of == vector.channel.frame) return frame.axes;
    return carried(frame.axes, frames_.at(frame.axes_of), frames_.at(vector.channel.frame));
  }

  // The file's vectors at one direction and phase, and their products with those of the model that
  // they may be.
  struct Vectors {
    std::vector<double> squares;
    std::vector<std::vector<std::size_t>> allowed;
    std::vector<std::vector<Products>> products;
  };

  Vectors vectors_at(double sign, double phase) const {
    Vectors at;
    at.products.resize(groups_.size());
    at.allowed.resize(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::array<Series, 3> parts;
      std::array<std::optional<double>, 3> own_squares;
      double square = 0;
      for (std::size_t j = 0; j < 3; ++j)
        if (groups_[g].columns[j]) {
          parts[j] = sampled(*groups_[g].columns[j], sign, phase, n_);
          own_squares[j] = dot(parts[j], parts[j]);
          square += *own_squares[j];
        }
      const auto words = words_of(groups_[g].key);
      const auto* unit = compare::find_unit(groups_[g].unit);
      for (const bool by_name : {true, false}) {
        if (!at.allowed[g].empty()) break;
        for (std::size_t v = 0; v < vectors_.size(); ++v)
          if ((unit == nullptr || unit->family == vectors_[v].channel.unit) &&
              (!by_name || is_quantity(words, vectors_[v].channel.quantity)))
            at.allowed[g].push_back(v);
      }
      at.products[g].resize(vectors_.size());
      for (const std::size_t v : at.allowed[g]) {
        Products& p = at.products[g][v];
        p.theirs_theirs = own_squares;
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j) {
            if (!parts[j].empty()) p.theirs_ours[j][i] = dot(parts[j], vectors_[v].parts[i]);
            p.ours_ours[j][i] = dot(vectors_[v].parts[j], vectors_[v].parts[i]);
          }
      }
      at.squares.push_back(square);
    }
    return at;
  }

  // How well vector v in a frame is group g: of both signs the better or the one wanted (0 =
  // either).
  Match match(const Vectors& at, std::size_t g, std::size_t v, const FrameChoice& frame,
              int wanted) const {
    const Channel& ours = vectors_[v].channel;
    const Axes axes = to_own(frame, vectors_[v]);
    double product = 0, own = 0;
    for (std::size_t j = 0; j < 3; ++j)
      if (groups_[g].columns[j]) add_component(at.products[g][v], axes, j, product, own);
    Match m =
        match_of(at.squares[g], product, own, ours.unit, ours.unit_in_si, groups_[g].unit, wanted);
    m.index = v;
    return m;
  }

  // A turned frame and a reversal both, shown by a single vector with three components, would also
  // be the error of one sign.
  bool may_reverse(const FrameChoice& frame) const {
    const auto whole = std::count_if(groups_.begin(), groups_.end(),
                                     [](const Group& group) { return group.count() == 3; });
    return whole > 1 || frame.plain();
  }

  // The best vector for each group, in one frame.
  Assignment in_frame(const Vectors& at, const FrameChoice& frame) const {
    Assignment a;
    a.frame = frame;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      Match found;
      for (const std::size_t v : at.allowed[g]) {
        const Match m = match(at, g, v, frame, 0);
        if (m.cost < found.cost) found = m;
      }
      a.groups.push_back(found);
    }
    std::vector<std::string> names;
    for (const Group& group : groups_) names.push_back(group.key);
    a.numbered += use_one_numbering(vectors_, names, a.groups);
    use_one_sign(
        vectors_, a.groups,
        [&](std::size_t g, int wanted) { return match(at, g, a.groups[g].index, frame, wanted); },
        [&](const Channel&, int fitting) { return may_reverse(frame) ? fitting : 1; });
    for (const Match& m : a.groups) a.cost += std::min(m.cost, 1.0);
    a.score = score_of(at, a);
    return a;
  }

  // By logarithms, so that the vectors which fit decide and not the one that does not. A vector may
  // fit with its components exchanged or of other signs: that is one error of the file, and needs a
  // smaller one than a frame that turns all of them for its sake.
  double score_of(const Vectors& at, const Assignment& a) const {
    constexpr double kRoundOff = 1e-8;
    const double fault = std::log(4), turned = std::log(1.1);
    double score = a.frame.plain() ? 0 : turned;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      double mixed = 1;
      for (const std::size_t v : at.allowed[g])
        mixed = std::min(mixed, mixed_cost(at, g, v, a.frame));
      score += std::min(std::log(kRoundOff + std::min(a.groups[g].cost, 1.0)),
                        fault + std::log(kRoundOff + mixed));
    }
    return score;
  }

  // The unit that makes vector v as large as group g, and the factor to it; no name: none does.
  struct BySize {
    std::string unit;
    double factor = 0;
  };
  BySize unit_by_size(const Vectors& at, std::size_t g, std::size_t v) const {
    const auto& squares = at.products[g][v].ours_ours;
    const Channel& ours = vectors_[v].channel;
    const double own = squares[0][0] + squares[1][1] + squares[2][2];
    if (own <= 0) return {};
    const std::string unit =
        unit_for(std::sqrt(at.squares[g] / own), ours.unit, ours.unit_in_si, groups_[g].unit);
    if (unit.empty()) return {};
    return {unit, ours.unit_in_si / compare::find_unit(unit)->si};
  }

  // How well vector v in a frame is group g with its components in another order and of any signs.
  double mixed_cost(const Vectors& at, std::size_t g, std::size_t v,
                    const FrameChoice& frame) const {
    const BySize by = unit_by_size(at, g, v);
    if (by.unit.empty()) return 1;
    return cost_of_mixed(at.products[g][v], to_own(frame, vectors_[v]), by.factor);
  }

  Assignment assign(double sign, double phase) const {
    const Vectors at = vectors_at(sign, phase);
    Assignment best = in_frame(at, {});
    // Of frames that fit as well the plainest, which come first.
    const auto keep = [&](Assignment a) {
      if (a.score < best.score - kBetter) best = std::move(a);
    };
    for (const char* base : {"S1", "S2"}) keep(in_frame(at, {base, compare::kNoTurn, "", {}}));
    for (const char* base : {"", "S1", "S2"})
      for (const Axes& axes : right_angles()) keep(in_frame(at, {base, axes, "", {}}));
    const bool whole =
        std::any_of(groups_.begin(), groups_.end(), [](const Group& g) { return g.count() == 3; });
    if (whole && best.cost > kPoorFrame * static_cast<double>(groups_.size()))
      if (auto turned = at_any_angle(at)) keep(std::move(*turned));
    find_wrong_signs(at, best);
    assign_columns(best, sign, phase);
    return best;
  }

  // The products of group g with vector v in the axes of S1, over the size of that vector.
  Axes products_in_s1(const Vectors& at, std::size_t g, std::size_t v) const {
    const Products& p = at.products[g][v];
    const Axes plain = to_own({"S1", compare::kNoTurn, "", {}}, vectors_[v]);
    const double size = std::sqrt(p.ours_ours[0][0] + p.ours_ours[1][1] + p.ours_ours[2][2]);
    Axes out{};
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i) out[j][k] += p.theirs_ours[j][i] * plain[k][i] / size;
    return out;
  }

  // The best frame that is not one at right angles, by Wahba's problem for the vectors with three
  // components.
  std::optional<Assignment> at_any_angle(const Vectors& at) const {
    FrameChoice frame{"S1", compare::kNoTurn, "", {}};
    Assignment best = in_frame(at, frame);
    // What each vector alone shows, as the one of ours that a rotation brings nearest to it.
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (const int sign : {1, -1}) {
        if (groups_[g].count() < 3 || (sign < 0 && groups_.size() == 1)) continue;
        double most = 0;
        for (const std::size_t v : at.allowed[g]) {
          const Axes products = products_in_s1(at, g, v);
          const Axes axes = nearest_rotation({products}, {double(sign)});
          const double fit = sign * trace_of(axes, products);
          if (!(fit > most)) continue;
          most = fit;
          frame.axes = axes;
        }
        // Of two that fit as well the one without a reversal, which comes first.
        Assignment a = in_frame(at, frame);
        if (a.score < best.score - kBetter) best = std::move(a);
      }
    // All of them together. A vector weighs the less the more it differs: one that is wrong does
    // not turn the frame of the others.
    constexpr int kSteps = 10;
    Assignment last = best;
    for (int step = 0; step < kSteps; ++step) {
      std::vector<Axes> products;
      std::vector<double> weights;
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        const Match& m = last.groups[g];
        if (groups_[g].count() < 3 || !m.found()) continue;
        products.push_back(products_in_s1(at, g, m.index));
        weights.push_back(m.sign / ((m.cost * m.cost + 1e-16) * std::sqrt(at.squares[g])));
      }
      frame.axes = nearest_rotation(products, weights);
      last = in_frame(at, frame);
      if (last.score < best.score) best = last;
    }
    for (const char* base : {"S1", "S2"})
      if (angle_from_right_angles(carried(best.frame.axes, frames_.at("S1"), frames_.at(base))) <
          kSameFrame)
        return std::nullopt;
    return with_round_angles(at, best);
  }

  // The same frame by the roundest Euler angles that fit as well.
  Assignment with_round_angles(const Vectors& at, const Assignment& exact) const {
    FrameChoice best;
    double roundest_step = -1;
    for (const char* sequence : {"ZXZ", "XYZ"}) {
      const auto turned = [&](const std::vector<double>& angles) {
        // Adding 0 makes 0 of -0, which is printed.
        const std::array<double, 3> three = {angles[0] + 0.0, angles[1] + 0.0, angles[2] + 0.0};
        return FrameChoice{exact.frame.axes_of, compare::turned_axes(sequence, three), sequence,
                           three};
      };
      const auto cost = [&](const std::vector<double>& angles) {
        constexpr double kRoundOff = 1e-14;
        double sum = 0;
        for (const Match& m : in_frame(at, turned(angles)).groups)
          sum += std::log(kRoundOff + std::min(1.0, m.cost * m.cost));
        return sum / static_cast<double>(groups_.size());
      };
      const auto start = euler_angles(exact.frame.axes, sequence);
      std::vector<double> angles(start.begin(), start.end());
      const double step = roundest(cost, angles);
      if (step <= roundest_step) continue;
      roundest_step = step;
      best = turned(angles);
    }
    return in_frame(at, best);
  }

  // Groups that no vector fits but one would with other signs of single components.
  void find_wrong_signs(const Vectors& at, Assignment& best) const {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (best.groups[g].cost < kNoChannel) continue;
      constexpr double kSameButSigns = 0.3;
      double least = kSameButSigns;
      const int piston = best.groups[g].found() && piston_in(groups_[g].key, pistons_) > 0
                             ? vectors_[best.groups[g].index].channel.piston
                             : 0;  // set by the numbering
      for (const std::size_t v : at.allowed[g]) {
        const Channel& ours = vectors_[v].channel;
        if (piston > 0 && ours.piston != piston) continue;
        const BySize by = unit_by_size(at, g, v);
        if (by.unit.empty()) continue;
        Match m;
        m.index = v;
        m.unit = by.unit;
        const double cost =
            cost_without_signs(at.products[g][v], to_own(best.frame, vectors_[v]), by.factor);
        if (cost >= least) continue;
        least = cost;
        m.cost = 1;
        m.signs_differ = true;
        for (std::size_t other = 0; other < groups_.size(); ++other)
          if (other != g && best.groups[other].found() && !best.groups[other].signs_differ &&
              vectors_[best.groups[other].index].channel.quantity == ours.quantity)
            m.sign = best.groups[other].sign;
        best.groups[g] = m;
      }
    }
  }

  // One numbering of the pistons for the file: number in the name = first + direction x ours. What
  // does not follow it is set right, so that pistons which were mixed up stay so.
  // @returns  how many have the number that their names say
  template <class Ours>
  int use_one_numbering(const std::vector<Ours>& ours, const std::vector<std::string>& names,
                        std::vector<Match>& matches) const {
    std::vector<std::pair<int, int>> votes;  // the number in the name, the piston found
    std::vector<Match*> voters;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const int piston = matches[i].found() ? ours[matches[i].index].channel.piston : 0;
      const int said = piston > 0 ? piston_in(names[i], pistons_) : 0;
      if (said == 0) continue;
      votes.emplace_back(said, piston);
      voters.push_back(&matches[i]);
    }
    if (votes.empty()) return 0;
    const auto numbering = best_numbering(votes, pistons_);
    int numbered = 0;
    for (std::size_t i = 0; i < votes.size(); ++i) {
      const int wanted = numbering(votes[i].first);
      numbered += wanted == votes[i].first;
      const Channel& now = ours[voters[i]->index].channel;
      const auto other = std::find_if(ours.begin(), ours.end(), [&](const Ours& one) {
        return one.channel.quantity == now.quantity && one.channel.axis == now.axis &&
               one.channel.piston == wanted;
      });
      if (other != ours.end()) voters[i]->index = static_cast<std::size_t>(other - ours.begin());
    }
    return numbered;
  }

  // One sign per quantity.
  // @param match_with  the match of a place with a sign
  // @param choose  of a channel and the sign that fits its quantity: the sign to use
  template <class Ours, class MatchWith, class Choose>
  static void use_one_sign(const std::vector<Ours>& ours, std::vector<Match>& matches,
                           const MatchWith& match_with, const Choose& choose) {
    std::map<std::string, std::array<double, 2>> costs;  // of + and -
    const auto quantity = [&](const Match& m) { return ours[m.index].channel.quantity; };
    for (std::size_t i = 0; i < matches.size(); ++i)
      if (matches[i].found())
        for (const int s : {0, 1})
          costs[quantity(matches[i])][s] += std::min(2.0, match_with(i, s == 0 ? 1 : -1).cost);
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (!matches[i].found()) continue;
      const auto& both = costs[quantity(matches[i])];
      matches[i] =
          match_with(i, choose(ours[matches[i].index].channel, both[1] < both[0] ? -1 : 1));
    }
  }

  // The channel that a column looks like by itself, whatever its factor and sign; "": none.
  std::string channel_like(std::size_t column, double sign, double phase) const {
    const Series theirs = normalised(sampled(column, sign, phase, n_));
    const auto* unit = compare::find_unit(known_unit(table_.units[column]));
    double most = kMinCorrelation;
    std::string name;
    for (const ModelChannel& one : channels_) {
      if (unit != nullptr && unit->family != one.channel.unit) continue;
      const double correlation = std::abs(dot(theirs, normalised(one.values)));
      if (correlation < most) continue;
      most = correlation;
      name = one.channel.name;
    }
    return name;
  }

  // Columns that belong to no vector: each one channel.
  void assign_columns(Assignment& a, double sign, double phase) const {
    std::map<std::string, int> signs;  // of quantities that vectors have
    for (const Match& m : a.groups)
      if (m.found()) signs[vectors_[m.index].channel.quantity] = m.sign;
    std::vector<Series> curves;
    std::vector<std::string> names;
    const auto match_channel = [&](std::size_t i, std::size_t c, int wanted) {
      const Channel& ours = channels_[c].channel;
      const Series &theirs = curves[i], &values = channels_[c].values;
      Match m = match_of(dot(theirs, theirs), dot(theirs, values), dot(values, values), ours.unit,
                         ours.unit_in_si, known_unit(table_.units[singles_[i]]), wanted);
      m.index = c;
      return m;
    };
    for (std::size_t i = 0; i < singles_.size(); ++i) {
      const std::size_t column = singles_[i];
      curves.push_back(sampled(column, sign, phase, n_));
      names.push_back(table_.header[column]);
      const auto words = words_of(names[i]);
      const auto* unit = compare::find_unit(known_unit(table_.units[column]));
      Match found;
      for (const bool by_name : {true, false}) {
        if (found.found()) break;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
          const Channel& channel = channels_[c].channel;
          if (unit != nullptr && unit->family != channel.unit) continue;
          if (by_name && !named(words, channel)) continue;
          // A pressure pushes; it has no other body to be seen from.
          const Match m = match_channel(i, c, channel.kind == ChannelKind::input ? 1 : 0);
          if (m.cost < found.cost) found = m;
        }
      }
      a.columns.push_back(found);
    }
    a.numbered += use_one_numbering(channels_, names, a.columns);
    use_one_sign(
        channels_, a.columns,
        [&](std::size_t i, int wanted) { return match_channel(i, a.columns[i].index, wanted); },
        [&](const Channel& channel, int fitting) {
          const auto fixed = signs.find(channel.quantity);
          return channel.kind == ChannelKind::input ? 1
                 : fixed != signs.end()             ? fixed->second
                                                    : fitting;
        });
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
  std::vector<std::string> undecided_;  // of these, what must be decided
};

// What is compared in the end, per group or column: theirs against ours, mapped to theirs.
struct Pairing {
  std::string theirs, ours, unit;
  int sign = 1;
  std::vector<std::size_t> columns;
  std::vector<Series> curves;  // of the model, in their unit, sign and axes
  // As the description says it: columns, or the vector.
  std::vector<compare::ColumnMap> maps;
  std::optional<compare::VectorMap> vector;
};

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
  guess.unrecognised = undecided_;
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
  std::set<std::string> taken;
  // Whether columns stand for a channel or vector, each of which is taken once; if not, why.
  const auto take = [&](const Match& m, const Channel* ours, bool by_name,
                        const std::vector<std::size_t>& columns) {
    const bool fits =
        ours != nullptr && (m.cost < kNoChannel || m.signs_differ || (by_name && m.cost < 2.5));
    if (fits && taken.insert(ours->name).second) return true;
    // A vector that is none of ours though some of its components are: something is wrong with it.
    std::string parts;
    for (const std::size_t column : columns)
      if (const std::string name = fits ? "" : channel_like(column, found.sign, phase);
          !name.empty())
        parts += (parts.empty() ? "" : ", ") + table_.header[column] + " looks like " + name;
    for (const std::size_t column : columns) {
      guess.ignored.emplace_back(
          table_.header[column],
          fits ? "like another column, looks like " + ours->name
          : parts.empty()
              ? "no channel has a similar curve"
              : "not recognised: " + parts +
                    (columns.size() > 1 ? ", but together they are not a vector of the pump"
                                        : ", but is of another size"));
      if (!parts.empty()) guess.unrecognised.push_back(table_.header[column]);
    }
    return false;
  };

  const bool own_plain = a.frame.axes_of.empty() && a.frame.plain();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const Match& m = a.groups[g];
    const Channel* found_channel = m.found() ? &vectors_[m.index].channel : nullptr;
    // Its name says the quantity, or which of the pistons it is.
    const bool by_name =
        m.found() && (is_quantity(words_of(group.key), found_channel->quantity) ||
                      (found_channel->piston > 0 && piston_in(group.key, pistons_) > 0));
    std::vector<std::size_t> columns;
    for (const auto& column : group.columns)
      if (column) columns.push_back(*column);
    if (!take(m, found_channel, by_name, columns)) continue;
    const ModelVector& vector = vectors_[m.index];
    const double unit = compare::find_unit(m.unit)->si;
    const double factor = m.sign * vector.channel.unit_in_si / unit;
    const Axes axes = to_own(a.frame, vector);
    Pairing pairing{"", vector.channel.name, m.unit, m.sign, columns, {}, {}, {}};
    compare::VectorMap map;
    map.ours = vector.channel.name;
    map.unit = m.unit;
    map.unit_in_si = unit;
    map.factor = m.sign;
    bool simple = own_plain;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!group.columns[j]) continue;
      const std::size_t column = *group.columns[j];
      map.theirs[j] = table_.header[column];
      pairing.theirs += (pairing.theirs.empty() ? "" : ", ") + table_.header[column];
      Series ours(n_, 0);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t row = 0; row < n_; ++row)
          ours[row] += factor * axes[j][i] * vector.parts[i][row];
      pairing.curves.push_back(std::move(ours));
      rounding(column, unit / vector.channel.unit_in_si, vector.peak);
      simple = simple && vector.has_channel[j];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      if (simple && group.columns[j])
        pairing.maps.push_back({map.theirs[j], vector.names[j], m.unit, unit, double(m.sign)});
      if (!simple || group.columns[j]) taken.insert(vector.names[j]);
    }
    if (!simple) pairing.vector = std::move(map);
    pairings.push_back(std::move(pairing));
  }
  for (std::size_t i = 0; i < singles_.size(); ++i) {
    const Match& m = a.columns[i];
    const std::size_t column = singles_[i];
    const Channel* found_channel = m.found() ? &channels_[m.index].channel : nullptr;
    const bool by_name = m.found() && named(words_of(table_.header[column]), *found_channel);
    if (!take(m, found_channel, by_name, {column})) continue;
    const ModelChannel& ours = channels_[m.index];
    const double unit = compare::find_unit(m.unit)->si;
    Pairing pairing{table_.header[column], ours.channel.name, m.unit, m.sign, {column}, {}, {}, {}};
    Series values = ours.values;
    for (double& value : values) value *= m.sign * ours.channel.unit_in_si / unit;
    pairing.curves.push_back(std::move(values));
    pairing.maps.push_back(
        {table_.header[column], ours.channel.name, m.unit, unit, double(m.sign)});
    pairings.push_back(std::move(pairing));
    rounding(column, unit / ours.channel.unit_in_si, ours.peak);
  }
  if (pairings.empty())
    throw InputError(table_.file.string() +
                     ": no column resembles a curve of the model; is it a record of this case?");

  // The phase: the best one, then the roundest that is as good. By logarithms, so that the curves
  // which fit decide and not the one that does not.
  const auto square_difference = [&](const Pairing& pairing, double at) {
    double difference = 0, square = 0;
    for (std::size_t k = 0; k < pairing.columns.size(); ++k) {
      const Series theirs = sampled(pairing.columns[k], found.sign, at, n_);
      for (std::size_t row = 0; row < n_; ++row)
        difference += std::pow(theirs[row] - pairing.curves[k][row], 2);
      square += dot(theirs, theirs);
    }
    return square > 0 ? std::optional(difference / square) : std::nullopt;
  };
  const auto cost = [&](double at) {
    constexpr double kRoundOff = 1e-24;
    double sum = 0;
    for (const Pairing& pairing : pairings)
      if (const auto square = square_difference(pairing, at)) sum += std::log(kRoundOff + *square);
    return sum / static_cast<double>(pairings.size());
  };
  std::vector<double> round_phase = {
      phase + numerics::smallest_at([&](double moved) { return cost(phase + moved); }, -0.5, 0.5)};
  roundest([&](const std::vector<double>& at) { return cost(at.front()); }, round_phase);
  phase = round_phase.front();
  // A small shift that leaves curves apart is as likely an error of the model: of its port timing.
  constexpr double kSmallShift = 10;         // deg
  const double decisive = 2 * std::log(10);  // of the logarithm of a mean square difference
  if (std::abs(phase) < kSmallShift && cost(phase) > cost(0) - decisive)
    std::swap(phase, guess.shift_not_taken_deg);
  for (const Pairing& pairing : pairings) {
    MappingProposal proposal{pairing.theirs, pairing.ours, pairing.sign, pairing.unit, 0, 0, ""};
    double product = 0, theirs_square = 0, ours_square = 0, without_signs = 0;
    bool ours_constant = true;  // then nothing but its value says what it is
    for (std::size_t k = 0; k < pairing.columns.size(); ++k) {
      const Series theirs = sampled(pairing.columns[k], found.sign, phase, n_);
      const Series x = centred(theirs), y = centred(pairing.curves[k]);
      product += dot(x, y);
      without_signs += std::abs(dot(x, y));
      ours_constant = ours_constant && is_constant(pairing.curves[k]);
      theirs_square += dot(x, x);
      ours_square += dot(y, y);
      const std::string unit = contradicting_unit(pairing.columns[k], pairing.unit);
      if (!unit.empty() && proposal.remark.empty()) proposal.remark = "the file says " + unit;
    }
    const double scale = std::sqrt(theirs_square * ours_square);
    proposal.correlation = scale > 0 ? product / scale : 0;
    const double followed =
        pairing.columns.size() > 1 && scale > 0 ? without_signs / scale : proposal.correlation;
    proposal.difference = std::sqrt(square_difference(pairing, phase).value_or(0));
    if (proposal.difference > kNoChannel)
      proposal.remark = pairing.columns.size() > 1 ? "signs differ, or only the name matches"
                                                   : "the name matches, the curve does not";
    if (!ours_constant && !(followed >= kMinCorrelation)) {
      for (const std::size_t column : pairing.columns) {
        guess.ignored.emplace_back(
            table_.header[column],
            fmt::format(
                "not recognised: looks like {}, but the correlation is {:.2f}, less than {:g}",
                pairing.ours, proposal.correlation, kMinCorrelation));
        guess.unrecognised.push_back(table_.header[column]);
      }
      continue;
    }
    for (compare::ColumnMap map : pairing.maps) {
      map.file_says = contradicting_unit(column_of(map.theirs), pairing.unit);
      curve.columns.push_back(std::move(map));
    }
    if (pairing.vector) {
      curve.vectors.push_back(*pairing.vector);
      for (const std::size_t column : pairing.columns)
        if (const std::string says = contradicting_unit(column, pairing.unit); !says.empty())
          curve.vectors.back().file_says = says;
    }
    guess.proposals.push_back(std::move(proposal));
  }
  if (guess.proposals.empty())
    throw InputError(table_.file.string() +
                     ": no column resembles a curve of the model with a correlation of at least " +
                     number_text(kMinCorrelation) + "; is it a record of this case?");
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
  if (!curve.vectors.empty()) {
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

#include "mapping_assignment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bentaxis/pump/lists.h"
#include "mapping_phase.h"

namespace bentaxis::study::mapping {
namespace {

// Frames at right angles that leave more than this are compared with frames at any angle.
constexpr double kPoorFrame = 0.02;
// A frame nearer than this to one at right angles is that frame: the angle between them is an error
// of the record or of the model, and must be seen.
constexpr double kSameFrame = 5;  // deg
// One error of a file weighs as much as a difference this many times as large.
constexpr double kFault = 4;
// Of a cost.
constexpr double kRoundOff = 1e-8;
// Of two frames the one whose score is smaller by less than this fits as well.
constexpr double kBetter = 1e-6;

// One numbering of the pistons for the file: number in the name = first + direction x ours. What
// does not follow it is set right, so that pistons which were mixed up stay so.
// @returns  how many have the number that their names say
template <class Ours>
int use_one_numbering(const std::vector<Ours>& ours, const std::vector<std::string>& names,
                      int pistons, std::vector<Match>& matches) {
  std::vector<std::pair<int, int>> votes;  // the number in the name, the piston found
  std::vector<Match*> voters;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const int piston = matches[i].found() ? ours[matches[i].index].channel.piston : 0;
    const int said = piston > 0 ? piston_in(names[i], pistons) : 0;
    if (said == 0) continue;
    votes.emplace_back(said, piston);
    voters.push_back(&matches[i]);
  }
  if (votes.empty()) return 0;
  const auto numbering = best_numbering(votes, pistons);
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
void use_one_sign(const std::vector<Ours>& ours, std::vector<Match>& matches,
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
    matches[i] = match_with(i, choose(ours[matches[i].index].channel, both[1] < both[0] ? -1 : 1));
  }
}

// What is kept of a match for the sum over all.
double summed_cost(const std::vector<Match>& matches) {
  double sum = 0;
  for (const Match& m : matches) sum += std::min(m.cost, 1.0);
  return sum;
}

// The vectors of a record at one direction and phase, and their products with those of the model
// that they may be.
class VectorAssigner {
 public:
  VectorAssigner(const Record& record, const ModelCurves& model, const Turning& turning)
      : record_(record), groups_(record.groups()), model_(model), vectors_(model.vectors()) {
    for (const Group& group : groups_) add(group, turning);
  }

  Assignment best() const {
    Assignment best = in_frame({});
    // Of frames that fit as well the plainest, which come first.
    const auto keep = [&](Assignment a) {
      if (a.score < best.score - kBetter) best = std::move(a);
    };
    for (const char* base : {"S1", "S2"}) keep(in_frame({base, compare::kNoTurn, "", {}}));
    for (const char* base : {"", "S1", "S2"})
      for (const Axes& axes : right_angles()) keep(in_frame({base, axes, "", {}}));
    if (record_.has_whole_vector() && best.cost > kPoorFrame * static_cast<double>(groups_.size()))
      if (auto turned = at_any_angle()) keep(std::move(*turned));
    if (!best.frame.plain()) best.one_is_wrong = rivals_of(best);
    find_wrong_signs(best);
    return best;
  }

 private:
  void add(const Group& group, const Turning& turning) {
    std::array<Series, 3> parts;
    std::array<std::optional<double>, 3> own_squares;
    double square = 0;
    for (std::size_t j = 0; j < 3; ++j)
      if (group.columns[j]) {
        parts[j] = record_.sampled(*group.columns[j], turning, model_.rows());
        own_squares[j] = dot(parts[j], parts[j]);
        square += *own_squares[j];
      }
    squares_.push_back(square);
    allowed_.push_back(allowed_for(group));
    products_.emplace_back(vectors_.size());
    for (const std::size_t v : allowed_.back()) {
      Products& p = products_.back()[v];
      p.theirs_theirs = own_squares;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          if (!parts[j].empty()) p.theirs_ours[j][i] = dot(parts[j], vectors_[v].parts[i]);
          p.ours_ours[j][i] = dot(vectors_[v].parts[j], vectors_[v].parts[i]);
        }
    }
  }

  // Those that the name says, or all of its unit.
  std::vector<std::size_t> allowed_for(const Group& group) const {
    const auto words = words_of(group.key);
    std::vector<std::size_t> named, all;
    for (std::size_t v = 0; v < vectors_.size(); ++v) {
      if (!may_have(group.unit, vectors_[v].channel.unit)) continue;
      all.push_back(v);
      if (is_quantity(words, vectors_[v].channel.quantity)) named.push_back(v);
    }
    return named.empty() ? all : named;
  }

  // How well vector v in a frame is group g: of both signs the better or the one wanted (0 =
  // either).
  Match match(std::size_t g, std::size_t v, const FrameChoice& frame, int wanted) const {
    const Channel& ours = vectors_[v].channel;
    const Axes axes = to_own(frame, vectors_[v], model_);
    double product = 0, own = 0;
    for (std::size_t j = 0; j < 3; ++j)
      if (groups_[g].columns[j]) add_component(products_[g][v], axes, j, product, own);
    Match m =
        match_of(squares_[g], product, own, ours.unit, ours.unit_in_si, groups_[g].unit, wanted);
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
  Assignment in_frame(const FrameChoice& frame) const {
    Assignment a;
    a.frame = frame;
    std::vector<std::string> names;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      names.push_back(groups_[g].key);
      Match found;
      for (const std::size_t v : allowed_[g]) {
        const Match m = match(g, v, frame, 0);
        if (m.cost < found.cost) found = m;
      }
      a.groups.push_back(found);
    }
    a.numbered += use_one_numbering(vectors_, names, model_.pistons(), a.groups);
    use_one_sign(
        vectors_, a.groups,
        [&](std::size_t g, int wanted) { return match(g, a.groups[g].index, frame, wanted); },
        [&](const Channel&, int fitting) { return may_reverse(frame) ? fitting : 1; });
    a.cost += summed_cost(a.groups);
    a.score = score_of(a);
    return a;
  }

  // By logarithms, so that the vectors which fit decide and not the one that does not. A vector may
  // fit with its components exchanged or of other signs: that is one error of the file, and needs a
  // smaller one than a frame that turns all of them for its sake.
  double score_of(const Assignment& a) const {
    const double turned = std::log(1.1);
    double score = a.frame.plain() ? 0 : turned;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      double mixed = 1;
      for (const std::size_t v : allowed_[g]) mixed = std::min(mixed, mixed_cost(g, v, a.frame));
      score += std::min(std::log(kRoundOff + std::min(a.groups[g].cost, 1.0)),
                        std::log(kFault) + std::log(kRoundOff + mixed));
    }
    return score;
  }

  // Whether a group fits but for the order or the signs of its components.
  bool has_fault(const Assignment& a, std::size_t g) const {
    double mixed = 1;
    for (const std::size_t v : allowed_[g]) mixed = std::min(mixed, mixed_cost(g, v, a.frame));
    return kFault * (kRoundOff + mixed) < kRoundOff + std::min(a.groups[g].cost, 1.0);
  }

  std::vector<std::size_t> faults_of(const Assignment& a) const {
    std::vector<std::size_t> faults;
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (has_fault(a, g)) faults.push_back(g);
    return faults;
  }

  // A wrong sign in one vector leaves as much as a frame whose axes point the other way, a reversal
  // and a wrong sign in another vector. Where that is so, both vectors; else none.
  std::vector<std::size_t> rivals_of(const Assignment& best) const {
    const std::vector<std::size_t> faults = faults_of(best);
    std::vector<std::size_t> rivals = faults;
    for (int signs = 1; signs < 7 && !faults.empty(); ++signs) {
      // Of a reflection the reverse, which is a rotation.
      const int reflects = (signs & 1) ^ (signs >> 1 & 1) ^ (signs >> 2 & 1);
      FrameChoice other = best.frame;
      for (std::size_t j = 0; j < 3; ++j)
        if ((signs >> j & 1) != reflects)
          for (double& cosine : other.axes[j]) cosine = -cosine;
      const Assignment a = in_frame(other);
      if (a.score < best.score + std::log(kFault) / 2)
        for (const std::size_t g : faults_of(a)) add_once(rivals, g);
    }
    if (rivals == faults) return {};
    sort_once(rivals);
    return rivals;
  }

  static double size_of(const Products& p) {
    return p.ours_ours[0][0] + p.ours_ours[1][1] + p.ours_ours[2][2];
  }

  // The unit that makes vector v as large as group g, and the factor to it; no name: none does.
  struct BySize {
    std::string unit;
    double factor = 0;
  };
  BySize unit_by_size(std::size_t g, std::size_t v) const {
    const Channel& ours = vectors_[v].channel;
    const double own = size_of(products_[g][v]);
    if (own <= 0) return {};
    const std::string unit =
        unit_for(std::sqrt(squares_[g] / own), ours.unit, ours.unit_in_si, groups_[g].unit);
    if (unit.empty()) return {};
    return {unit, ours.unit_in_si / compare::find_unit(unit)->si};
  }

  // How well vector v in a frame is group g with its components in another order and of any signs.
  double mixed_cost(std::size_t g, std::size_t v, const FrameChoice& frame) const {
    const BySize by = unit_by_size(g, v);
    if (by.unit.empty()) return 1;
    return cost_of_mixed(products_[g][v], to_own(frame, vectors_[v], model_), by.factor);
  }

  // The products of group g with vector v in the axes of S1, over the size of that vector.
  Axes products_in_s1(std::size_t g, std::size_t v) const {
    const Products& p = products_[g][v];
    const Axes plain = to_own({"S1", compare::kNoTurn, "", {}}, vectors_[v], model_);
    const double size = std::sqrt(size_of(p));
    Axes out{};
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i) out[j][k] += p.theirs_ours[j][i] * plain[k][i] / size;
    return out;
  }

  // The best frame that is not one at right angles, by Wahba's problem for the vectors with three
  // components.
  std::optional<Assignment> at_any_angle() const {
    const Assignment best = by_all_vectors(by_one_vector());
    for (const char* base : {"S1", "S2"})
      if (angle_from_right_angles(
              carried(best.frame.axes, model_.frame("S1"), model_.frame(base))) < kSameFrame)
        return std::nullopt;
    return with_round_angles(best);
  }

  // What each vector alone shows, as the one of ours that a rotation brings nearest to it.
  Assignment by_one_vector() const {
    FrameChoice frame{"S1", compare::kNoTurn, "", {}};
    Assignment best = in_frame(frame);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (const int sign : {1, -1}) {
        if (groups_[g].count() < 3 || (sign < 0 && groups_.size() == 1)) continue;
        double most = 0;
        for (const std::size_t v : allowed_[g]) {
          const Axes products = products_in_s1(g, v);
          const Axes axes = nearest_rotation({products}, {double(sign)});
          const double fit = sign * trace_of(axes, products);
          if (!(fit > most)) continue;
          most = fit;
          frame.axes = axes;
        }
        // Of two that fit as well the one without a reversal, which comes first.
        Assignment a = in_frame(frame);
        if (a.score < best.score - kBetter) best = std::move(a);
      }
    return best;
  }

  // All of them together. A vector weighs the less the more it differs: one that is wrong does not
  // turn the frame of the others.
  Assignment by_all_vectors(Assignment best) const {
    constexpr int kSteps = 10;
    Assignment last = best;
    FrameChoice frame = best.frame;
    for (int step = 0; step < kSteps; ++step) {
      std::vector<Axes> products;
      std::vector<double> weights;
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        const Match& m = last.groups[g];
        if (groups_[g].count() < 3 || !m.found()) continue;
        products.push_back(products_in_s1(g, m.index));
        weights.push_back(m.sign / ((m.cost * m.cost + 1e-16) * std::sqrt(squares_[g])));
      }
      frame.axes = nearest_rotation(products, weights);
      last = in_frame(frame);
      if (last.score < best.score) best = last;
    }
    return best;
  }

  // The same frame by the roundest Euler angles that fit as well.
  Assignment with_round_angles(const Assignment& exact) const {
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
        constexpr double kOfSquares = 1e-14;
        double sum = 0;
        for (const Match& m : in_frame(turned(angles)).groups)
          sum += std::log(kOfSquares + std::min(1.0, m.cost * m.cost));
        return sum / static_cast<double>(groups_.size());
      };
      const auto start = euler_angles(exact.frame.axes, sequence);
      std::vector<double> angles(start.begin(), start.end());
      const double step = roundest(cost, angles);
      if (step <= roundest_step) continue;
      roundest_step = step;
      best = turned(angles);
    }
    return in_frame(best);
  }

  // Groups that no vector fits but one would with other signs of single components.
  void find_wrong_signs(Assignment& best) const {
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (best.groups[g].cost >= kNoChannel)
        if (const Match m = match_but_for_signs(best, g); m.found()) best.groups[g] = m;
  }

  Match match_but_for_signs(const Assignment& a, std::size_t g) const {
    constexpr double kSameButSigns = 0.3;
    double least = kSameButSigns;
    const int piston = a.groups[g].found() && piston_in(groups_[g].key, model_.pistons()) > 0
                           ? vectors_[a.groups[g].index].channel.piston
                           : 0;  // set by the numbering
    Match found;
    for (const std::size_t v : allowed_[g]) {
      const Channel& ours = vectors_[v].channel;
      const BySize by = unit_by_size(g, v);
      if (by.unit.empty() || (piston > 0 && ours.piston != piston)) continue;
      const double cost =
          cost_without_signs(products_[g][v], to_own(a.frame, vectors_[v], model_), by.factor);
      if (cost >= least) continue;
      least = cost;
      found = {v, sign_of_others(a, g, ours.quantity), by.unit, 1, true};
    }
    return found;
  }

  // The sign that other groups of a quantity have.
  int sign_of_others(const Assignment& a, std::size_t g, const std::string& quantity) const {
    int sign = 1;
    for (std::size_t other = 0; other < groups_.size(); ++other)
      if (other != g && a.groups[other].found() && !a.groups[other].signs_differ &&
          vectors_[a.groups[other].index].channel.quantity == quantity)
        sign = a.groups[other].sign;
    return sign;
  }

  const Record& record_;
  const std::vector<Group>& groups_;
  const ModelCurves& model_;
  const std::vector<ModelVector>& vectors_;
  // By group:
  std::vector<double> squares_;
  std::vector<std::vector<std::size_t>> allowed_;
  std::vector<std::vector<Products>> products_;
};

// Columns that belong to no vector: each one channel.
class ColumnAssigner {
 public:
  ColumnAssigner(const Record& record, const ModelCurves& model, const Turning& turning)
      : record_(record), model_(model), channels_(model.channels()) {
    for (const std::size_t column : record.singles()) {
      curves_.push_back(record.sampled(column, turning, model.rows()));
      names_.push_back(record.table().header[column]);
    }
  }

  void assign(Assignment& a) const {
    std::map<std::string, int> signs;  // of quantities that vectors have
    for (const Match& m : a.groups)
      if (m.found()) signs[model_.vectors()[m.index].channel.quantity] = m.sign;
    for (std::size_t i = 0; i < names_.size(); ++i) a.columns.push_back(best_for(i));
    a.numbered += use_one_numbering(channels_, names_, model_.pistons(), a.columns);
    use_one_sign(
        channels_, a.columns,
        [&](std::size_t i, int wanted) { return match(i, a.columns[i].index, wanted); },
        [&](const Channel& channel, int fitting) {
          const auto fixed = signs.find(channel.quantity);
          return channel.kind == ChannelKind::input ? 1
                 : fixed != signs.end()             ? fixed->second
                                                    : fitting;
        });
    a.cost += summed_cost(a.columns);
  }

 private:
  std::string unit_of(std::size_t i) const { return record_.unit_of(record_.singles()[i]); }

  Match match(std::size_t i, std::size_t c, int wanted) const {
    const Channel& ours = channels_[c].channel;
    const Series &theirs = curves_[i], &values = channels_[c].values;
    Match m = match_of(dot(theirs, theirs), dot(theirs, values), dot(values, values), ours.unit,
                       ours.unit_in_si, unit_of(i), wanted);
    m.index = c;
    return m;
  }

  // Of those that the name says, or of all.
  Match best_for(std::size_t i) const {
    const auto words = words_of(names_[i]);
    Match found;
    for (const bool by_name : {true, false}) {
      if (found.found()) break;
      for (std::size_t c = 0; c < channels_.size(); ++c) {
        const Channel& channel = channels_[c].channel;
        if (!may_have(unit_of(i), channel.unit) || (by_name && !named(words, channel))) continue;
        // A pressure pushes; it has no other body to be seen from.
        const Match m = match(i, c, channel.kind == ChannelKind::input ? 1 : 0);
        if (m.cost < found.cost) found = m;
      }
    }
    return found;
  }

  const Record& record_;
  const ModelCurves& model_;
  const std::vector<ModelChannel>& channels_;
  std::vector<Series> curves_;
  std::vector<std::string> names_;
};

}  // namespace

Axes to_own(const FrameChoice& frame, const ModelVector& vector, const ModelCurves& model) {
  const std::string& own = vector.channel.frame;
  if (frame.axes_of.empty() || frame.axes_of == own) return frame.axes;
  return carried(frame.axes, model.frame(frame.axes_of), model.frame(own));
}

Assignment assignment_of(const Record& record, const ModelCurves& model, const Turning& turning) {
  Assignment best = VectorAssigner(record, model, turning).best();
  ColumnAssigner(record, model, turning).assign(best);
  return best;
}

}  // namespace bentaxis::study::mapping

#include "mapping_proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>

#include "bentaxis/numerics/minimum.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "mapping_assignment.h"

namespace bentaxis::study::mapping {
namespace {

// Channels of the model and factors, whose sum is a curve.
using Terms = std::vector<std::pair<std::string, double>>;

Series sum_of(const Terms& terms, const ResultTable& model) {
  Series sum(model.rows(), 0);
  for (const auto& [name, factor] : terms) {
    const std::size_t column = model.find(name);
    for (std::size_t row = 0; row < sum.size(); ++row) sum[row] += factor * model.at(row, column);
  }
  return sum;
}

// What is compared in the end, per group or column: theirs against ours, mapped to theirs.
struct Pairing {
  std::string theirs, ours, unit;
  int sign = 1;
  std::vector<std::size_t> columns;
  std::vector<Terms> ours_of;  // the model's curve for each, in their unit, sign and axes
  std::vector<Series> curves;  // these at the model's angles
  // As the description says it: columns, or the vector.
  std::vector<compare::ColumnMap> maps;
  std::optional<compare::VectorMap> vector;
};

// What a match may be taken for.
struct Candidate {
  const Match* match;
  const Channel* ours;  // nullptr: nothing was found
  bool by_name;         // its name says the quantity, or which of the pistons it is
  std::vector<std::size_t> columns;
};

class Proposer {
 public:
  Proposer(const Record& record, const ModelCurves& model, const Phase& phase,
           const compare::ResultAt& model_at)
      : record_(record),
        table_(record.table()),
        model_(model),
        model_at_(model_at),
        phase_(phase),
        turning_(phase.turning) {}

  MappingGuess propose() {
    choose_piston();
    guess_.ignored = record_.ignored();
    guess_.unrecognised = record_.undecided();
    guess_.curve.file = table_.file;
    guess_.curve.sheet = table_.sheet;
    guess_.curve.points = static_cast<int>(table_.rows.size());
    guess_.curve.models = {"analytic", "multibody"};
    guess_.curve.guessed = true;
    for (std::size_t g = 0; g < record_.groups().size(); ++g) pair_group(g);
    for (std::size_t i = 0; i < record_.singles().size(); ++i) pair_column(i);
    if (pairings_.empty()) refuse("");
    for (const std::size_t g : assignment_.one_is_wrong)
      guess_.curve.one_is_wrong.push_back(
          model_.vectors()[assignment_.groups[g].index].channel.name);
    find_phase();
    state_angle();
    for (const Pairing& pairing : pairings_) propose(pairing);
    if (guess_.proposals.empty())
      refuse(" with a correlation of at least " + number_text(kMinCorrelation));
    std::stable_sort(guess_.proposals.begin(), guess_.proposals.end(),
                     [](const auto& x, const auto& y) { return x.difference > y.difference; });
    for (const auto& [column, why] : guess_.ignored) guess_.curve.ignored.push_back(column);
    if (!guess_.curve.vectors.empty()) state_frame();
    return std::move(guess_);
  }

 private:
  [[noreturn]] void refuse(const std::string& how) const {
    throw InputError(table_.file.string() + ": no column resembles a curve of the model" + how +
                     "; is it a record of this case?");
  }

  // Another piston's angle is the same turn: the numbers in the names say which, else the smallest
  // shift.
  void choose_piston() {
    struct Variant {
      double phase;
      Assignment assignment;
    };
    std::vector<Variant> variants;
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i < std::max(1, model_.pistons()); ++i) {
      double phase = std::remainder(phase_.turning.phase + i * model_.pitch_deg(), 360.0);
      if (std::abs(phase) > 180 - 1e-6) phase = 180;
      variants.push_back({phase, assignment_of(record_, model_, {turning_.sign, phase})});
      least = std::min(least, variants.back().assignment.cost);
    }
    const auto worth = [&](const Variant& v) {
      return std::tuple(v.assignment.cost > 1.02 * least + 1e-4, -v.assignment.numbered,
                        std::round(std::abs(v.phase) * 1e3));
    };
    auto best =
        std::min_element(variants.begin(), variants.end(),
                         [&](const Variant& a, const Variant& b) { return worth(a) < worth(b); });
    turning_.phase = best->phase;
    assignment_ = std::move(best->assignment);
  }

  std::string header(std::size_t column) const { return table_.header[column]; }

  // Whether columns stand for a channel or vector, each of which is taken once; if not, says why.
  bool take(const Candidate& candidate) {
    const Match& m = *candidate.match;
    const bool fits = candidate.ours != nullptr && (m.cost < kNoChannel || m.signs_differ ||
                                                    (candidate.by_name && m.cost < 2.5));
    if (fits && taken_.insert(candidate.ours->name).second) return true;
    // A vector that is none of ours though some of its components are: something is wrong with it.
    std::string parts;
    for (const std::size_t column : candidate.columns)
      if (const std::string name = fits ? "" : channel_like(column); !name.empty())
        parts += (parts.empty() ? "" : ", ") + header(column) + " looks like " + name;
    for (const std::size_t column : candidate.columns) {
      guess_.ignored.emplace_back(
          header(column), fits ? "like another column, looks like " + candidate.ours->name
                          : parts.empty()
                              ? "no channel has a similar curve"
                              : "not recognised: " + parts +
                                    (candidate.columns.size() > 1
                                         ? ", but together they are not a vector of the pump"
                                         : ", but is of another size"));
      if (!parts.empty()) guess_.unrecognised.push_back(header(column));
    }
    return false;
  }

  // The channel that a column looks like by itself, whatever its factor and sign; "": none.
  std::string channel_like(std::size_t column) const {
    const Series theirs = normalised(record_.sampled(column, turning_, model_.rows()));
    double most = kMinCorrelation;
    std::string name;
    for (const ModelChannel& one : model_.channels()) {
      if (!may_have(record_.unit_of(column), one.channel.unit)) continue;
      const double correlation = std::abs(dot(theirs, normalised(one.values)));
      if (correlation < most) continue;
      most = correlation;
      name = one.channel.name;
    }
    return name;
  }

  // The rounding and the digits of a column that is mapped.
  void note_rounding(std::size_t column, double in_our_unit, double peak) {
    double largest = 0;
    for (const auto& row : table_.rows)
      if (is_computed(row[column])) largest = std::max(largest, std::abs(row[column]));
    const int digits = table_.digits[column] > 0
                           ? table_.digits[column]
                           : *std::max_element(table_.digits.begin(), table_.digits.end());
    if (digits > 0) guess_.digits = guess_.digits == 0 ? digits : std::min(guess_.digits, digits);
    if (largest == 0 || digits == 0 || peak == 0) return;
    guess_.rounding =
        std::max(guess_.rounding, half_of_last_digit(largest, digits) * in_our_unit / peak);
  }

  void pair_group(std::size_t g) {
    const Group& group = record_.groups()[g];
    const Match& m = assignment_.groups[g];
    Candidate candidate{&m, m.found() ? &model_.vectors()[m.index].channel : nullptr, false, {}};
    if (const Channel* const ours = candidate.ours)
      candidate.by_name = is_quantity(words_of(group.key), ours->quantity) ||
                          (ours->piston > 0 && piston_in(group.key, model_.pistons()) > 0);
    for (const auto& column : group.columns)
      if (column) candidate.columns.push_back(*column);
    if (!take(candidate)) return;
    const ModelVector& vector = model_.vectors()[m.index];
    const double unit = compare::find_unit(m.unit)->si;
    const Axes axes = to_own(assignment_.frame, vector, model_);
    Pairing pairing{"", vector.channel.name, m.unit, m.sign, candidate.columns, {}, {}, {}, {}};
    compare::VectorMap map;
    map.ours = vector.channel.name;
    map.unit = m.unit;
    map.unit_in_si = unit;
    map.factor = m.sign;
    bool simple = assignment_.frame.axes_of.empty() && assignment_.frame.plain();
    for (std::size_t j = 0; j < 3; ++j) {
      if (!group.columns[j]) continue;
      const std::size_t column = *group.columns[j];
      map.theirs[j] = header(column);
      pairing.theirs += (pairing.theirs.empty() ? "" : ", ") + header(column);
      const double factor = m.sign * vector.channel.unit_in_si / unit;
      Terms& terms = pairing.ours_of.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        if (vector.has_channel[i]) terms.emplace_back(vector.names[i], factor * axes[j][i]);
      note_rounding(column, unit / vector.channel.unit_in_si, vector.peak);
      simple = simple && vector.has_channel[j];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      if (simple && group.columns[j])
        pairing.maps.push_back({map.theirs[j], vector.names[j], m.unit, unit, double(m.sign)});
      if (!simple || group.columns[j]) taken_.insert(vector.names[j]);
    }
    if (!simple) pairing.vector = std::move(map);
    add(std::move(pairing));
  }

  void add(Pairing pairing) {
    for (const Terms& terms : pairing.ours_of)
      pairing.curves.push_back(sum_of(terms, model_.table()));
    pairings_.push_back(std::move(pairing));
  }

  void pair_column(std::size_t i) {
    const Match& m = assignment_.columns[i];
    const std::size_t column = record_.singles()[i];
    Candidate candidate{
        &m, m.found() ? &model_.channels()[m.index].channel : nullptr, false, {column}};
    candidate.by_name = m.found() && named(words_of(header(column)), *candidate.ours);
    if (!take(candidate)) return;
    const ModelChannel& ours = model_.channels()[m.index];
    const double unit = compare::find_unit(m.unit)->si;
    Pairing pairing{header(column), ours.channel.name, m.unit, m.sign, {column}, {}, {}, {}, {}};
    pairing.ours_of = {{{ours.channel.name, m.sign * ours.channel.unit_in_si / unit}}};
    pairing.maps.push_back({header(column), ours.channel.name, m.unit, unit, double(m.sign)});
    add(std::move(pairing));
    note_rounding(column, unit / ours.channel.unit_in_si, ours.peak);
  }

  // Curves of a pairing, theirs and ours at the same angles.
  using Curves = std::vector<std::pair<Series, Series>>;

  // At the model's angles, which splines through the record give.
  Curves sampled(const Pairing& pairing, double phase) const {
    Curves curves;
    for (std::size_t k = 0; k < pairing.columns.size(); ++k)
      curves.emplace_back(
          record_.sampled(pairing.columns[k], {turning_.sign, phase}, model_.rows()),
          pairing.curves[k]);
    return curves;
  }

  // At the record's own angles, where the model can be run there: as `regress` compares them.
  Curves at_own_angles(const Pairing& pairing) const {
    if (!model_at_) return sampled(pairing, turning_.phase);
    Curves curves;
    for (std::size_t k = 0; k < pairing.columns.size(); ++k) {
      Series theirs;
      for (const std::size_t row : own_turn_.rows)
        theirs.push_back(table_.rows[row][pairing.columns[k]]);
      curves.emplace_back(std::move(theirs), sum_of(pairing.ours_of[k], own_model_));
    }
    return curves;
  }

  static std::optional<double> square_difference(const Curves& curves) {
    double difference = 0, square = 0;
    for (const auto& [theirs, ours] : curves) {
      for (std::size_t row = 0; row < theirs.size(); ++row)
        difference += std::pow(theirs[row] - ours[row], 2);
      square += dot(theirs, theirs);
    }
    return square > 0 ? std::optional(difference / square) : std::nullopt;
  }

  // By logarithms, so that the curves which fit decide and not the one that does not.
  double cost_at(double phase) const {
    constexpr double kRoundOff = 1e-24;
    double sum = 0;
    for (const Pairing& pairing : pairings_)
      if (const auto square = square_difference(sampled(pairing, phase)))
        sum += std::log(kRoundOff + *square);
    return sum / static_cast<double>(pairings_.size());
  }

  // The best phase, then the roundest that is as good.
  void find_phase() {
    double& phase = turning_.phase;
    std::vector<double> round_phase = {
        phase +
        numerics::smallest_at([&](double moved) { return cost_at(phase + moved); }, -0.5, 0.5)};
    roundest([&](const std::vector<double>& at) { return cost_at(at.front()); }, round_phase);
    phase = round_phase.front();
    // A small shift that leaves curves apart is as likely an error of the model: of its port
    // timing.
    constexpr double kSmallShift = 10;         // deg
    const double decisive = 2 * std::log(10);  // of the logarithm of a mean square difference
    if (std::abs(phase) < kSmallShift && cost_at(phase) > cost_at(0) - decisive)
      std::swap(phase, guess_.shift_not_taken_deg);
  }

  // How a pairing's curves go together.
  struct Likeness {
    double correlation = 0;
    double followed = 0;        // the same, whatever the signs of single components
    bool ours_constant = true;  // then nothing but its value says what it is
  };
  static Likeness likeness_of(const Curves& curves) {
    Likeness found;
    double product = 0, theirs_square = 0, ours_square = 0, without_signs = 0;
    for (const auto& [theirs, ours] : curves) {
      const Series x = centred(theirs), y = centred(ours);
      product += dot(x, y);
      without_signs += std::abs(dot(x, y));
      theirs_square += dot(x, x);
      ours_square += dot(y, y);
      found.ours_constant = found.ours_constant && is_constant(ours);
    }
    const double scale = std::sqrt(theirs_square * ours_square);
    if (scale > 0) found.correlation = product / scale;
    found.followed = curves.size() > 1 && scale > 0 ? without_signs / scale : found.correlation;
    return found;
  }

  // The vectors that have a wrong sign if this one has none.
  std::string others_of(const std::string& vector) const {
    std::vector<std::string> others = guess_.curve.one_is_wrong;
    std::erase(others, vector);
    return joined(others, " or ");
  }

  void propose(const Pairing& pairing) {
    MappingProposal proposal{pairing.theirs, pairing.ours, pairing.sign, pairing.unit, 0, 0, ""};
    const Curves curves = at_own_angles(pairing);
    const Likeness like = likeness_of(curves);
    proposal.correlation = like.correlation;
    proposal.difference = std::sqrt(square_difference(curves).value_or(0));
    for (const std::size_t column : pairing.columns)
      if (const std::string says = record_.contradicting_unit(column, pairing.unit);
          !says.empty() && proposal.remark.empty())
        proposal.remark = "the file says " + says;
    if (contains(guess_.curve.one_is_wrong, pairing.ours))
      proposal.remark = "this or " + others_of(pairing.ours) + " has a component of the wrong sign";
    else if (proposal.difference > kNoChannel)
      proposal.remark = pairing.columns.size() > 1 ? "signs differ, or only the name matches"
                                                   : "the name matches, the curve does not";
    if (!like.ours_constant && !(like.followed >= kMinCorrelation)) {
      for (const std::size_t column : pairing.columns) {
        guess_.ignored.emplace_back(
            header(column),
            fmt::format(
                "not recognised: looks like {}, but the correlation is {:.2f}, less than {:g}",
                pairing.ours, proposal.correlation, kMinCorrelation));
        guess_.unrecognised.push_back(header(column));
      }
      return;
    }
    compare::CurveDescription& curve = guess_.curve;
    for (compare::ColumnMap map : pairing.maps) {
      map.file_says = record_.contradicting_unit(record_.column_of(map.theirs), pairing.unit);
      curve.columns.push_back(std::move(map));
    }
    if (pairing.vector) {
      curve.vectors.push_back(*pairing.vector);
      for (const std::size_t column : pairing.columns)
        if (const std::string says = record_.contradicting_unit(column, pairing.unit);
            !says.empty())
          curve.vectors.back().file_says = says;
    }
    guess_.proposals.push_back(std::move(proposal));
  }

  void state_angle() {
    AngleMap& angle = guess_.curve.angle;
    angle = phase_.angle;
    angle.sign = turning_.sign;
    angle.offset_deg = turning_.phase;
    if (angle.turn_from_deg)
      *angle.turn_from_deg =
          turning_.phase + (turning_.sign > 0 ? *angle.turn_from_deg : -*angle.turn_from_deg - 360);
    // Angles that a run of as many samples has: then nothing need be resampled.
    own_turn_ = record_.turn_of(angle);
    if (model_at_) own_model_ = model_at_(own_turn_.theta_deg);
    const compare::Turn& turn = own_turn_;
    const double step = 360.0 / static_cast<double>(turn.rows.size());
    const double same = std::max(1e-9, angle.rounding_deg);
    if (same < step / 10 &&
        std::all_of(turn.theta_deg.begin(), turn.theta_deg.end(),
                    [&](double at) { return std::abs(std::remainder(at, step)) <= same; }))
      guess_.samples = static_cast<int>(turn.rows.size());
  }

  void state_frame() {
    const FrameChoice& chosen = assignment_.frame;
    compare::FrameMap& frame = guess_.curve.frame;
    frame.axes_of = chosen.axes_of;
    frame.cosines = chosen.axes;
    frame.words =
        chosen.axes_of.empty() ? "the axes of each reaction" : "the axes of " + chosen.axes_of;
    if (!chosen.euler.empty())
      frame.words += fmt::format(", turned by {:g}, {:g}, {:g} deg about {}", chosen.angles[0],
                                 chosen.angles[1], chosen.angles[2], chosen.euler);
    else if (!chosen.plain())
      frame.words += ", exchanged";
    guess_.euler = chosen.euler;
    guess_.euler_deg = chosen.angles;
  }

  const Record& record_;
  const ForeignTable& table_;
  const ModelCurves& model_;
  const compare::ResultAt& model_at_;  // no function: at its own angles alone
  const Phase& phase_;
  Turning turning_;
  compare::Turn own_turn_;  // of the record
  ResultTable own_model_;   // at its angles
  Assignment assignment_;
  std::vector<Pairing> pairings_;
  std::set<std::string> taken_;  // channels and vectors
  MappingGuess guess_;
};

}  // namespace

MappingGuess proposal_of(const Record& record, const ModelCurves& model, const Phase& phase,
                         const compare::ResultAt& model_at) {
  return Proposer(record, model, phase, model_at).propose();
}

}  // namespace bentaxis::study::mapping

#include "bentaxis/designs/explain.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/designs/variable.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/run.h"

namespace bentaxis::designs {
namespace {

using study::ExplainingChange;
using study::Explanation;

constexpr std::size_t kMostAngles = 720;  // that are looked at
constexpr std::size_t kRefined = 6;       // changes that are computed again, best of the linear fit
constexpr std::size_t kRefinedPairs = 3;  // they cost more each
constexpr double kWorthRefining = 0.1;    // share by the linear fit
constexpr int kSteps = 6, kHalvings = 6;
constexpr double kDone = 1e-12;  // of the difference, or by which a step still lowers it

// A number that is compared.
struct Column {
  std::string name;
  std::size_t in_layout;
  double weight;   // 1 / peak
  double allowed;  // over peak, where the reference is at its best
};

class Search {
 public:
  Search(const study::Outcome& outcome, const Case& base, const study::PartProgress& progress_of)
      : base_(base), progress_of_(progress_of) {
    const auto held = outcome.held.find("analytic");
    if (held == outcome.held.end()) throw InputError("the analytic model was not compared.");
    const ResultTable& result = held->second.result;
    const ResultTable& reference = held->second.reference;
    if (result.theta_deg != reference.theta_deg ||
        std::any_of(result.theta_deg.begin(), result.theta_deg.end(),
                    [](double angle) { return angle < 0 || angle >= 360; }))
      throw InputError("the results are not those of a driven turn.");
    choose_columns(outcome, held->second);
    choose_angles(result);
    collect(held->second);
  }

  Explanation find() {
    Explanation found;
    if (difference_ <= 0) {
      found.reason = "the analytic model does not differ at the angles compared.";
      return found;
    }
    differentiate();
    found.tried = variables_.size();
    if (variables_.empty()) {
      found.reason = "no parameter of this case has exact derivatives.";
      return found;
    }
    const Progress progress = progress_of_("what would explain the difference");
    found.left_out = leave_out();
    if (found.cause() != nullptr) return found;
    found.singles = refine(ranked_singles(), progress);
    const ExplainingChange* const cause = found.cause();
    if (cause == nullptr || (all_conditions(*cause) && cause->rest_over_allowed > 1))
      found.pairs = refine(ranked_pairs(cause != nullptr), progress);
    return found;
  }

 private:
  using Choice = std::vector<std::size_t>;  // variables

  void choose_columns(const study::Outcome& outcome, const study::Outcome::Held& held) {
    const ResultTable &result = held.result, &reference = held.reference;
    const ChannelLayout layout(base_.pump);
    reactions_ = layout.reactions();
    for (const study::GroupLine& line : outcome.lines)
      for (const compare::ReferenceChannel& channel : line.channels) {
        const auto& c = channel.comparison;
        if (line.model != "analytic" || study::severity(channel) < 0 || !(c.peak > 0)) continue;
        if (channel.finding == compare::Finding::incomplete) continue;
        const auto place =
            std::find_if(layout.channels().begin(), layout.channels().end(),
                         [&](const Channel& one) { return one.name == c.channel.name; });
        if (place == layout.channels().end() || result.find(c.channel.name) == result.columns() ||
            reference.find(c.channel.name) == reference.columns())
          continue;
        const double off = held.resampling.at(row_of(result, c.theta_of_largest_deg),
                                              held.resampling.find(c.channel.name));
        columns_.push_back({c.channel.name,
                            static_cast<std::size_t>(place - layout.channels().begin()), 1 / c.peak,
                            (c.allowed - off) / c.peak});
        si_.push_back(place->unit_in_si);
      }
    if (columns_.empty()) throw InputError("no channel of the analytic model was compared.");
  }

  static std::size_t row_of(const ResultTable& table, double theta_deg) {
    const auto it = std::find(table.theta_deg.begin(), table.theta_deg.end(), theta_deg);
    return static_cast<std::size_t>(it - table.theta_deg.begin()) % table.rows();
  }

  // Not too many, evenly spread.
  void choose_angles(const ResultTable& result) {
    const std::size_t all = result.rows();
    std::size_t stride = 1;
    while ((all - 1) / stride >= kMostAngles) ++stride;
    for (std::size_t row = 0; row < all; row += stride) {
      rows_.push_back(row);
      angles_.push_back(result.theta_deg[row]);
    }
  }

  void collect(const study::Outcome::Held& held) {
    const std::size_t all = rows_.size() * columns_.size();
    wanted_.setZero(index(all));
    known_.assign(all, false);
    here_ = allowed_ = wanted_;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const Column& column = columns_[c];
      const std::size_t a = held.result.find(column.name), b = held.reference.find(column.name),
                        off = held.resampling.find(column.name);
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const double ours = held.result.at(rows_[i], a), theirs = held.reference.at(rows_[i], b);
        if (!std::isfinite(ours) || !std::isfinite(theirs)) continue;
        const std::size_t at = i * columns_.size() + c;
        known_[at] = true;
        wanted_[index(at)] = theirs * column.weight;
        here_[index(at)] = ours * column.weight;
        allowed_[index(at)] = column.allowed + held.resampling.at(rows_[i], off) * column.weight;
      }
    }
    difference_ = (wanted_ - here_).squaredNorm();
  }

  // Fills the derivatives of what is compared.
  void differentiate() {
    variables_ = differentiate_reactions(
        base_,
        [&](std::size_t row, const std::vector<double>&, const std::vector<double>& derivatives) {
          const std::size_t count = derivatives.size() / reactions_;
          if (jacobian_.size() == 0)
            jacobian_.setZero(wanted_.size(), static_cast<Eigen::Index>(count));
          for (std::size_t c = 0; c < columns_.size(); ++c) {
            const std::size_t at = row * columns_.size() + c;
            if (columns_[c].in_layout >= reactions_ || !known_[at]) continue;
            for (std::size_t d = 0; d < count; ++d) {
              const double slope = derivatives[d * reactions_ + columns_[c].in_layout];
              if (std::isfinite(slope))
                jacobian_(static_cast<Eigen::Index>(at), static_cast<Eigen::Index>(d)) =
                    slope * columns_[c].weight / si_[c];
            }
          }
        },
        progress_of_, angles_);
    if (variables_.empty()) return;
    normal_ = jacobian_.transpose() * jacobian_;
    right_ = jacobian_.transpose() * (wanted_ - here_);
  }

  double norm(std::size_t v) const { return std::sqrt(normal_(index(v), index(v))); }
  double correlation(std::size_t a, std::size_t b) const {
    const double size = norm(a) * norm(b);
    return size > 0 ? normal_(index(a), index(b)) / size : 0;
  }
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  // Share of the difference that some variables explain by the linear fit.
  double linear_share(const Choice& choice) const {
    const double a = norm(choice[0]);
    if (!(a > 0)) return 0;
    const double first = right_[index(choice[0])] / a;
    if (choice.size() == 1) return first * first / difference_;
    const double b = norm(choice[1]), cosine = correlation(choice[0], choice[1]);
    if (!(b > 0) || std::abs(cosine) >= Explanation::kLookSame) return 0;
    const double second = (right_[index(choice[1])] / b - cosine * first);
    return (first * first + second * second / (1 - cosine * cosine)) / difference_;
  }

  // How well a change explains: an operating condition is named before what is as good, and of
  // several of them the one that changes least.
  static double worth(const ExplainingChange& change) {
    if (!all_conditions(change)) return change.share;
    double largest = 0;
    for (const auto& p : change.parameters)
      largest =
          std::max(largest, std::abs(p.to - p.from) / std::max(std::abs(p.to), std::abs(p.from)));
    return change.share + Explanation::kAsWell * (1 - std::min(1.0, largest) / 2);
  }
  static bool all_conditions(const ExplainingChange& change) {
    return std::all_of(change.parameters.begin(), change.parameters.end(),
                       [](const auto& p) { return study::is_operating_condition(p.name); });
  }
  bool all_conditions(const Choice& choice) const {
    return std::all_of(choice.begin(), choice.end(), [&](std::size_t v) {
      return study::is_operating_condition(variables_[v].name());
    });
  }

  // The best of them, and all of operating conditions alone.
  std::vector<Choice> best(std::vector<Choice> choices, std::size_t most) const {
    std::vector<std::pair<double, Choice>> ranked;
    for (Choice& choice : choices)
      if (const double share = linear_share(choice); share >= kWorthRefining)
        ranked.emplace_back(share, std::move(choice));
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& x, const auto& y) { return x.first > y.first; });
    std::vector<Choice> list;
    for (auto& one : ranked)
      if (list.size() < most || all_conditions(one.second)) list.push_back(std::move(one.second));
    return list;
  }

  std::vector<Choice> ranked_singles() const {
    std::vector<Choice> all;
    for (std::size_t v = 0; v < variables_.size(); ++v) all.push_back({v});
    return best(std::move(all), kRefined);
  }

  std::vector<Choice> ranked_pairs(bool of_conditions) const {
    std::vector<Choice> all;
    for (std::size_t a = 0; a < variables_.size(); ++a)
      for (std::size_t b = a + 1; b < variables_.size(); ++b)
        if (!of_conditions || all_conditions({a, b})) all.push_back({a, b});
    return best(std::move(all), kRefinedPairs);
  }

  // What is compared, of changed variables; nothing where they make no pump that runs.
  std::optional<Eigen::VectorXd> results(const Family& family, const Eigen::VectorXd& x) const {
    Eigen::VectorXd found = Eigen::VectorXd::Zero(wanted_.size());
    const std::string reason = study::reason_of([&] {
      Case changed = base_;
      family.make({x.data(), static_cast<std::size_t>(x.size())}, changed);
      const ResultTable table = study::run_at_angles(study::prepare(changed), angles_, {});
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        const std::size_t column = table.find(columns_[c].name);
        for (std::size_t row = 0; row < table.rows(); ++row)
          if (const std::size_t at = row * columns_.size() + c; known_[at])
            found[index(at)] = table.at(row, column) * columns_[c].weight;
      }
    });
    if (!reason.empty() || !found.allFinite()) return std::nullopt;
    return found;
  }

  // Gauss-Newton steps from the case; derivatives follow by Broyden's update.
  ExplainingChange fit(const Choice& choice) const {
    std::vector<Variable> variables;
    Eigen::MatrixXd slopes(wanted_.size(), index(choice.size()));
    Eigen::VectorXd x(index(choice.size()));
    for (std::size_t i = 0; i < choice.size(); ++i) {
      variables.push_back(variables_[choice[i]]);
      slopes.col(index(i)) = jacobian_.col(index(choice[i]));
      x[index(i)] = variables.back().value(base_);
    }
    const Eigen::VectorXd start = x;
    const Family family(base_, variables);
    Eigen::VectorXd now = here_;
    double left = difference_;
    for (int step = 0; step < kSteps && left > kDone * difference_; ++step) {
      Eigen::VectorXd scale = slopes.colwise().norm();
      for (double& size : scale)
        if (!(size > 0)) size = 1;
      Eigen::VectorXd change =
          numerics::LeastSquaresSolver(slopes * scale.cwiseInverse().asDiagonal())
              .solve(wanted_ - now)
              .cwiseQuotient(scale);
      bool lower = false;
      for (int half = 0; half <= kHalvings && !lower; ++half, change /= 2) {
        const auto there = results(family, x + change);
        if (!there) continue;
        const double then = (wanted_ - *there).squaredNorm();
        const Eigen::VectorXd scaled = change.cwiseProduct(scale);
        const Eigen::VectorXd miss = *there - now - slopes * change;
        slopes += miss * scaled.cwiseProduct(scale).transpose() / scaled.squaredNorm();
        if (!(then < left)) continue;
        lower = true;
        x += change;
        now = *there;
        const bool enough = left - then < 1e-6 * left;
        left = then;
        if (enough) step = kSteps;
      }
      if (!lower) break;
    }
    return change_of(variables, choice, start, x, now);
  }

  ExplainingChange change_of(const std::vector<Variable>& variables, const Choice& choice,
                             const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                             const Eigen::VectorXd& now) const {
    ExplainingChange change;
    for (std::size_t i = 0; i < choice.size(); ++i) {
      change.parameters.push_back(
          {variables[i].name(), variables[i].unit(), from[index(i)], to[index(i)], {}});
      for (std::size_t v = 0; v < variables_.size(); ++v)
        if (v != choice[i] && std::abs(correlation(v, choice[i])) >= Explanation::kLookSame)
          change.parameters.back().look_same.push_back(variables_[v].name());
    }
    measure(change, now);
    return change;
  }

  // What another program may not model at all, where this case does.
  std::vector<ExplainingChange> leave_out() const {
    struct Off {
      const char* name;
      double value;  // in the file's unit
    };
    const std::vector<std::vector<Off>> wholes = {
        {{"friction.piston_coulomb_N", 0}, {"friction.piston_viscous_N_s_per_m", 0}},
        {{"friction.piston_coulomb_N", 0},
         {"friction.piston_viscous_N_s_per_m", 0},
         {"friction.block_viscous_Nm_per_rpm", 0},
         {"friction.shaft_viscous_Nm_per_rpm", 0},
         {"friction.shaft_torque_factor", 1}},
        {{"operation.gravity_m_per_s2", 0}},
        {{"piston.mass_kg", 0}}};
    std::vector<ExplainingChange> changes;
    for (const std::vector<Off>& whole : wholes) {
      ExplainingChange change;
      std::vector<Variable> variables;
      std::vector<double> values;
      for (const Off& off : whole) {
        std::optional<Variable> variable;
        // One that does nothing in this case cannot be left out of it.
        if (!study::reason_of([&] { variable.emplace(off.name, base_); }).empty()) continue;
        const double here = variable->value(base_);
        if (here == off.value) continue;
        change.parameters.push_back({off.name, variable->unit(), here, off.value, {}});
        variables.push_back(*variable);
        values.push_back(off.value);
      }
      if (variables.empty()) continue;
      const auto there =
          results(Family(base_, variables),
                  Eigen::Map<const Eigen::VectorXd>(values.data(), index(values.size())));
      if (!there) continue;
      measure(change, *there);
      if (change.share >= Explanation::kMentioned) changes.push_back(std::move(change));
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    return changes;
  }

  // How much of the difference a change takes away, and what is left.
  void measure(ExplainingChange& change, const Eigen::VectorXd& now) const {
    const Eigen::VectorXd rest = wanted_ - now;
    change.share = 1 - rest.squaredNorm() / difference_;
    Eigen::Index worst = 0;
    change.rest_over_peak = rest.cwiseAbs().maxCoeff(&worst);
    change.rest_channel = columns_[static_cast<std::size_t>(worst) % columns_.size()].name;
    for (Eigen::Index at = 0; at < rest.size(); ++at)
      if (known_[static_cast<std::size_t>(at)])
        change.rest_over_allowed =
            std::max(change.rest_over_allowed, std::abs(rest[at]) / allowed_[at]);
  }

  static bool is_small(const ExplainingChange& change) {
    return std::all_of(change.parameters.begin(), change.parameters.end(), [](const auto& p) {
      return p.from == 0 || study::is_operating_condition(p.name) ||
             std::abs(p.to - p.from) <= Explanation::kLargest * std::abs(p.from);
    });
  }

  // A value that no pump has explains nothing.
  bool stays_plausible(const ExplainingChange& change, const Choice& choice) const {
    for (std::size_t i = 0; i < choice.size(); ++i) {
      const PlausibleRange& range = variables_[choice[i]].parameter().plausible;
      const auto& [from, to] = std::pair(change.parameters[i].from, change.parameters[i].to);
      if ((to < range.low && from >= range.low) || (to > range.high && from <= range.high))
        return false;
    }
    return true;
  }

  std::vector<ExplainingChange> refine(const std::vector<Choice>& choices,
                                       const Progress& progress) const {
    std::vector<ExplainingChange> changes;
    std::size_t done = 0;
    for (const Choice& choice : choices) {
      ExplainingChange change = fit(choice);
      if (is_small(change) && stays_plausible(change, choice)) changes.push_back(std::move(change));
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(choices.size()));
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const auto& a, const auto& b) { return worth(a) > worth(b); });
    return changes;
  }

  Case base_;
  const study::PartProgress& progress_of_;
  std::vector<Column> columns_;
  std::vector<double> si_;  // unit of each
  std::size_t reactions_ = 0;
  std::vector<std::size_t> rows_;  // of what is held, that are looked at
  std::vector<double> angles_;     // of these
  Eigen::VectorXd wanted_, here_;  // of the reference and of the results, over peak
  Eigen::VectorXd allowed_;        // between them, over peak
  std::vector<bool> known_;
  double difference_ = 0;
  std::vector<Variable> variables_;
  Eigen::MatrixXd jacobian_, normal_;
  Eigen::VectorXd right_;
};

template <class CaseOf>
void explain_by(study::Outcome& outcome, const study::PartProgress& progress_of,
                const CaseOf& case_of) {
  const bool analytic_differs = std::any_of(
      outcome.lines.begin(), outcome.lines.end(),
      [](const study::GroupLine& line) { return line.model == "analytic" && line.differs(); });
  if (!outcome.differs() || outcome.held.empty()) return;
  Explanation found;
  try {
    if (analytic_differs)
      found = Search(outcome, case_of(), progress_of).find();
    else
      found.reason = "the analytic model agrees in all compared channels.";
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    found.reason = error.what();
  }
  outcome.explanation = std::move(found);
}

}  // namespace

void explain(study::Outcome& outcome, const Case& base, const study::PartProgress& progress_of) {
  explain_by(outcome, progress_of, [&]() -> const Case& { return base; });
}

void explain(study::Outcome& outcome, const study::ReferencePlace& place,
             const study::PartProgress& progress_of) {
  explain_by(outcome, progress_of, [&] {
    const auto description = compare::read_description(place.folder, place.name);
    Case base = read_case(description.case_file);
    if (description.samples_per_revolution)
      base.operation.samples_per_revolution = *description.samples_per_revolution;
    return base;
  });
}

}  // namespace bentaxis::designs

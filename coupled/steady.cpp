// Periodic motion as the fixed point of the map of an N-th of the block's turn.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bentaxis/coupled/simulation.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "hybrid_integrator.h"
#include "table.h"

namespace bentaxis::coupled {
namespace {

// Periods that are integrated before Newton's method starts: turns, at most, and until the states
// change by this part of their scales.
constexpr int kTurnsAhead = 20;
constexpr double kSettled = 1e-2;
constexpr int kAttempts = 3;
constexpr int kMaxIterations = 40;
constexpr double kMinDamping = 1.0 / 64;
// Central differences: their step, of the scales, and the tolerance of the integration beneath,
// whose noise they divide by the step.
constexpr double kStep = 1e-3;
constexpr double kToleranceForSlopes = 1e-11;
constexpr double kLoose = 1e-8;
constexpr double kSlow = 0.3;         // convergence that asks for new derivatives
constexpr double kNearEnough = 1e-4;  // of the scales: multipliers are those of there
constexpr double kEnd = 10;           // of the tolerance: a step that need not be taken
constexpr double kNoise = 300;  // of that of an integration: a residual that may be its errors
// A state is off by what an integration over a period is, amplified where disturbances decay
// slowly: the integration is as much finer, as far as double precision goes.
constexpr double kOfPeriod = 10;  // of its tolerance: errors over a period
constexpr double kFineEnough = 2;
constexpr double kFiner = 0.1;
constexpr double kFinest = 1e-13;
constexpr double kAtSection = 1e-12;  // rad
// Modes that come back as they went, as the mass in a closed circuit, are left where they are.
constexpr double kNeutral = 1e-6;

struct Passage {
  SystemState state;  // after the period, at time 0 again
  double period = 0;
  double slowest = 0;  // of the shaft, in the block's direction, rad/s
};

class PeriodMap {
 public:
  PeriodMap(const std::string& name, Mechanics& mechanics, const Oil& oil, const DriveSpec& drive,
            const Progress& progress)
      : name_(name),
        mechanics_(mechanics),
        oil_(oil),
        limit_(drive.duration),
        order_(oil.order_after_period()),
        progress_(progress) {
    const System system(mechanics, oil, false);
    const auto& active = system.active();
    for (std::size_t i = 0; i < system.scale().size(); ++i) {
      if (i < active.size()) {
        if (active[i] == kTurn) continue;  // that of the section
        motions_.push_back(active[i]);
      }
      scale_.push_back(system.scale()[i]);
    }
    if (mechanics.shaft_is_free()) return;
    const double speed = mechanics.shaft(0, mechanics.start()).speed;
    if (speed == 0) fail("the shaft does not turn");
    direction_ = speed > 0 ? 1 : -1;
    period_ = step_angle() / std::abs(speed);
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw ComputationError(name_ + " model: no periodic motion: " + why);
  }
  double step_angle() const { return 2 * kPi / oil_.pistons(); }
  int direction() const { return direction_; }
  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(scale_.size()); }

  Eigen::VectorXd scaled(const SystemState& s) const {
    Eigen::VectorXd u(unknowns());
    pack(s, motions_, scale_, u.data());
    return u;
  }
  SystemState state(const Eigen::VectorXd& u) const {
    SystemState s{mechanics_.start(), oil_.start()};
    unpack(u.data(), motions_, scale_, s);
    on_section(s);
    return s;
  }

  // Over one period. The first one finds out which way the block turns.
  Passage pass(const SystemState& from, double tolerance) {
    if (progress_) progress_(static_cast<double>(passes_) / (passes_ + kUsualPasses));
    ++passes_;
    if (unknowns() == 0) return {from, period_, std::abs(step_angle() / period_)};
    HybridIntegrator integrator(name_, mechanics_, oil_, tolerance, false);
    integrator.start(0, from);
    Passage passage;
    passage.state = from;
    passage.slowest = direction_ * integrator.shaft(0, from).speed;
    SystemState& at = passage.state;
    const double end = direction_ != 0 && period_ > 0 ? period_ : limit_;
    for (;;) {
      if (integrator.time() >= end) {
        if (period_ > 0) break;
        fail("the block does not turn by an N-th of a turn within " + number_text(limit_) +
             " s (duration_s): the drive may not turn the shaft at all");
      }
      integrator.advance(end);
      integrator.state_at(integrator.time(), at);
      passage.slowest =
          std::min(passage.slowest, direction_ * integrator.shaft(integrator.time(), at).speed);
      if (period_ > 0) continue;
      const double turned = integrator.block(integrator.time(), at).angle;
      if (std::abs(turned) < step_angle() - kAtSection) continue;
      const int way = turned > 0 ? 1 : -1;
      if (direction_ == 0) direction_ = way;
      if (way != direction_) fail("the block turns back");
      break;
    }
    passage.period = period_ > 0 ? period_ : integrator.time_at(direction_ * step_angle());
    integrator.state_at(passage.period, at);
    on_section(at);
    if (!order_.empty()) {
      const std::vector<double> before = at.oil;
      for (std::size_t i = 0; i < order_.size(); ++i) {
        const auto other = static_cast<std::size_t>(order_[i]);
        if (direction_ > 0)
          at.oil[i] = before[other];
        else
          at.oil[other] = before[i];
      }
    }
    return passage;
  }

 private:
  static constexpr int kUsualPasses = 100;

  // The block at angle 0 at time 0.
  void on_section(SystemState& s) const {
    if (!mechanics_.shaft_is_free()) return;
    s.motion[kTurn] = 0;
    s.motion[kTurn] = -mechanics_.block(0, s.motion).angle;
  }

  const std::string& name_;
  Mechanics& mechanics_;
  const Oil& oil_;
  double limit_;
  std::vector<int> order_;
  const Progress& progress_;
  std::vector<std::size_t> motions_;
  std::vector<double> scale_;
  int direction_ = 0;
  double period_ = 0;  // where the speed is given
  int passes_ = 0;
};

// A state, and where it comes to over a period.
struct Point {
  Eigen::VectorXd u, residual;
  Passage passage;
  double step = 0;   // the largest part of the one that would be next, of the scales
  double error = 0;  // with what the integration's errors amount to
  double size() const { return u.size() == 0 ? 0 : residual.norm(); }
  double largest() const { return u.size() == 0 ? 0 : residual.lpNorm<Eigen::Infinity>(); }
};

class Newton {
 public:
  Newton(PeriodMap& map, double tolerance)
      : map_(map), tolerance_(tolerance), integration_(tolerance) {}

  Point at(const Eigen::VectorXd& u) {
    Point p;
    p.u = u;
    p.passage = map_.pass(map_.state(u), integration_);
    p.residual = map_.scaled(p.passage.state) - u;
    return p;
  }

  std::optional<Point> try_at(const Eigen::VectorXd& u) {
    try {
      Point p = at(u);
      if (p.residual.allFinite()) return p;
    } catch (const ComputationError& error) {
      why_ = error.what();
    }
    return {};
  }

  // d(state after the period)/d(state): by central differences of a tight integration, or by
  // forward ones of a loose one, which is enough to begin with.
  Eigen::MatrixXd derivative(const Eigen::VectorXd& u, bool tight) {
    const double tolerance =
        tight ? std::min(tolerance_, kToleranceForSlopes) : std::max(tolerance_, kLoose);
    const auto beside = [&](Eigen::Index j, double step) {
      Eigen::VectorXd moved = u;
      moved[j] += step;
      return map_.scaled(map_.pass(map_.state(moved), tolerance).state);
    };
    const Eigen::VectorXd here = tight ? u : beside(0, 0);
    Eigen::MatrixXd by_state(u.size(), u.size());
    for (Eigen::Index j = 0; j < u.size(); ++j)
      by_state.col(j) = tight ? (beside(j, kStep) - beside(j, -kStep)) / (2 * kStep)
                              : (beside(j, kStep) - here) / kStep;
    return by_state;
  }

  // @return whether it has converged; `p` becomes the best point
  bool run(Point& p) {
    if (p.u.size() == 0) return true;
    bool fresh = false, tight = false;
    for (; iterations_ < kMaxIterations; ++iterations_) {
      if (by_state_.size() == 0) {
        find_slopes(p.u, tight);
        fresh = tight = true;
      }
      Eigen::VectorXd step = step_from(p);
      const bool noise = p.largest() <= kNoise * integration_;
      if ((noise || p.step <= kEnd * tolerance_) && !has_slopes_of(p)) {
        find_slopes(p.u, true);
        fresh = true;
        step = step_from(p);
      }
      if (noise || p.step <= kEnd * tolerance_) {
        const double enough = std::max(kFinest, tolerance_ / std::max(1.0, amplification_));
        if (integration_ > kFineEnough * enough && integrate_finer(p, enough)) continue;
        if (p.step <= kEnd * tolerance_) return true;
      }
      std::optional<Point> next;
      for (double damping = 1; damping >= kMinDamping; damping /= 2) {
        next = try_at(p.u + damping * step);
        if (next && next->size() < (1 - damping / 4) * p.size()) break;
        next.reset();
        if (noise) break;
      }
      if (!next && noise) {
        // What is left are errors of the integration.
        if (integrate_finer(p, kFiner * integration_)) continue;
        return p.largest() <= kNoise * tolerance_;
      }
      if (!next) {
        if (fresh && tight_at_.size() > 0) return false;
        by_state_.resize(0, 0);
        continue;
      }
      if (next->size() > kSlow * p.size() && next->largest() > kNoise * integration_)
        by_state_.resize(0, 0);
      fresh = false;
      p = std::move(*next);
    }
    return false;
  }

  std::vector<std::complex<double>> multipliers(const Point& p) {
    if (p.u.size() == 0) return {};
    if (!has_slopes_of(p)) find_slopes(p.u, true);
    const Eigen::VectorXcd values = numerics::eigenvalues(by_state_);
    std::vector<std::complex<double>> result(values.data(), values.data() + values.size());
    std::sort(result.begin(), result.end(),
              [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
    return result;
  }

  int iterations() const { return iterations_; }
  const std::string& why() const { return why_; }
  void start_again() {
    by_state_.resize(0, 0);
    integration_ = tolerance_;
  }

 private:
  void find_slopes(const Eigen::VectorXd& u, bool tight) {
    by_state_ = derivative(u, tight);
    tight_at_ = tight ? u : Eigen::VectorXd();
  }
  bool has_slopes_of(const Point& p) const {
    return by_state_.size() > 0 && tight_at_.size() > 0 &&
           (tight_at_ - p.u).lpNorm<Eigen::Infinity>() <= kNearEnough;
  }
  Eigen::VectorXd step_from(Point& p) {
    const numerics::ShortestSolver solver(
        Eigen::MatrixXd::Identity(p.u.size(), p.u.size()) - by_state_, kNeutral);
    amplification_ = solver.pseudo_inverse().rowwise().norm().maxCoeff();
    Eigen::VectorXd step = solver.solve(p.residual);
    p.step = step.lpNorm<Eigen::Infinity>();
    p.error = p.step + kOfPeriod * amplification_ * integration_;
    return step;
  }

  // @return whether it can be
  bool integrate_finer(Point& p, double tolerance) {
    if (tolerance < kFinest) return false;
    const double before = integration_;
    integration_ = tolerance;
    std::optional<Point> finer = try_at(p.u);
    if (finer)
      p = std::move(*finer);
    else
      integration_ = before;
    return finer.has_value();
  }

  PeriodMap& map_;
  double tolerance_;
  double integration_;        // its tolerance
  double amplification_ = 0;  // of errors over a period, to those of the state
  Eigen::MatrixXd by_state_;
  Eigen::VectorXd tight_at_;  // where it is by central differences
  int iterations_ = 0;
  std::string why_;
};

}  // namespace

SteadyMotion steady(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                    const Options& options, const Progress& progress) {
  const bool over_time = !drive.curve.time.empty() && drive.kind != DriveKind::motor;
  if (over_time || !mechanics.breakpoints().empty())
    throw InputError(
        "[drive] file: must be left out for a periodic motion: the drive changes over time");
  if (!oil.breakpoints().empty())
    throw InputError("[hydraulics]: the circuit must not change over time for a periodic motion");
  PeriodMap map(name, mechanics, oil, drive, progress);
  Newton newton(map, options.tolerance);
  SystemState start{mechanics.start(), oil.start()};
  Point p;
  bool converged = false;
  for (int attempt = 0; attempt < kAttempts && !converged; ++attempt) {
    newton.start_again();
    for (int i = 0; i < kTurnsAhead * oil.pistons(); ++i) {
      start = map.pass(start, options.tolerance).state;
      p = newton.at(map.scaled(start));
      if (i >= oil.pistons() && p.largest() < kSettled) break;
      start = p.passage.state;
    }
    converged = newton.run(p);
    start = p.passage.state;
  }
  if (!converged)
    map.fail("after " + std::to_string(newton.iterations()) +
             " steps of Newton's method a state still changes by " + rounded_text(p.largest()) +
             " of its scale over a period" + (newton.why().empty() ? "" : "; " + newton.why()));
  if (!(p.passage.slowest > 0)) map.fail("the shaft turns back within the period");

  SteadyMotion result;
  result.period_s = p.passage.period;
  result.speed = map.direction() * map.step_angle() / p.passage.period;
  result.iterations = newton.iterations();
  result.residual = p.largest();
  result.error = p.error;
  result.tolerance = options.tolerance;
  result.multipliers = newton.multipliers(p);
  const SystemState found = map.state(p.u);
  result.motion = found.motion;
  result.oil = found.oil;
  const double turn = result.period_s * oil.pistons();
  std::vector<double> times;
  for (int i = 0; i <= drive.samples; ++i) times.push_back(turn * i / drive.samples);
  Options of_turn = options;
  of_turn.exchange.reset();
  result.turn = tabulate(name, mechanics, oil, drive, found, times, of_turn, {});
  return result;
}

}  // namespace bentaxis::coupled

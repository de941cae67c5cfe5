// Steps through the motion: to every event, to every row.
#include <algorithm>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <cmath>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/results/stopwatch.h"
#include "simulation/equations.h"
#include "simulation/pieces.h"

namespace bentaxis::analytic {
namespace simulation {
namespace {

using closed_form::WallMode;

// Tolerance of a step, of the scales of the states, for a wanted error of the reactions: what
// remains is for the growth of errors over the motion.
constexpr double kStepShare = 1e-3;
// Rounding of a step, of a state's size: no tolerance below it can be met.
constexpr double kRounding = 1e-15;
constexpr double kTightest = 1e-14;
constexpr double kSmallestStep = 1e-14;      // of the duration, or of a second if that is less
constexpr double kFirstStep = 1e-3;          // of the duration, at most
constexpr long kMaxEvaluations = 100000000;  // of the closed form: some minutes
constexpr int kMaxEventsAtOnce = 64;         // without a step between them
constexpr double kOnTouch = 1e-15;           // m: as good as touching
constexpr double kOnEdge = 1e-15;            // of the angle and a turn
constexpr double kOnWall = 2e-17;            // m: a stiff wall gives 2 nN there
constexpr std::size_t kMaxEvents = 1000000;  // of contact

// One extrapolated step of scaled states; `h` becomes what the method would take next.
class Stepper {
 public:
  Stepper(Equations& equations, const State& scale, double tolerance)
      : equations_(equations), scale_(scale), method_(tolerance, kRounding, 1.0, 0.0) {}

  bool attempt(double time, const State& y, const State& dy, double& h, State& out) {
    State from, slope;
    for (std::size_t i = 0; i < kMotionStates; ++i) {
      from[i] = y[i] / scale_[i];
      slope[i] = dy[i] / scale_[i];
    }
    const auto system = [this](const State& x, State& dx, double t) {
      State at, rate;
      for (std::size_t i = 0; i < kMotionStates; ++i) at[i] = x[i] * scale_[i];
      equations_.rates(t, at, rate);
      for (std::size_t i = 0; i < kMotionStates; ++i) dx[i] = rate[i] / scale_[i];
    };
    const double asked = h;
    const auto result = method_.try_step(system, from, slope, time, out, h);
    for (std::size_t i = 0; i < kMotionStates; ++i) out[i] *= scale_[i];
    const bool finite =
        std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); });
    if (!finite || !std::isfinite(h)) {
      h = asked / 8;
      method_.reset();
      return false;
    }
    return result == boost::numeric::odeint::success;
  }

 private:
  Equations& equations_;
  State scale_;
  boost::numeric::odeint::bulirsch_stoer<State> method_;
};

// A value that ends the piece of motion where it rises above 0, with its rate.
struct EventFunction {
  double value, rate;
};

// First time in (0, h] at which the cubic through both ends is above 0; h or more: not within.
double first_above(const EventFunction& from, const EventFunction& to, double h) {
  const double a = from.value, b = from.rate * h;
  const double c = 3 * (to.value - from.value) - h * (2 * from.rate + to.rate);
  const double d = 2 * (from.value - to.value) + h * (from.rate + to.rate);
  const auto at = [&](double s) { return a + s * (b + s * (c + s * d)); };
  // Where it may turn back: roots of b + 2 c s + 3 d s^2.
  std::array<double, 3> ends = {2, 2, 1};
  const double discriminant = c * c - 3 * b * d;
  if (discriminant > 0) {
    const double q = -(c + std::copysign(std::sqrt(discriminant), c));
    if (d != 0) ends[0] = q / (3 * d);
    if (q != 0) ends[1] = b / q;
    if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
  }
  double low = 0;
  for (const double end : ends) {
    if (!(end > 0 && end <= 1)) continue;
    const bool above = end == 1 ? to.value > 0 : at(end) > 0;
    if (above) {
      constexpr int kHalvings = 60;
      return numerics::bisect({low, end}, kHalvings, [&](double s) { return at(s) > 0; }).high * h;
    }
    low = end;
  }
  return 2 * h;
}

// Lag theta - psi within a step.
class LagWithin {
 public:
  struct End {
    double lag, rate, acceleration;
  };
  // The polynomial of degree 5 through both ends.
  LagWithin(const End& from, const End& to, double h) : from_(from), h_(h) {
    const double rise = to.lag - from.lag - h * from.rate - h * h / 2 * from.acceleration;
    const double rate = (to.rate - from.rate - h * from.acceleration) * h;
    const double bend = (to.acceleration - from.acceleration) * h * h;
    cubic_ = 10 * rise - 4 * rate + bend / 2;
    quartic_ = -15 * rise + 7 * rate - bend;
    quintic_ = 6 * rise - 3 * rate + bend / 2;
  }

  // With this acceleration in the middle: what is added is a multiple of s^3 (1 - s)^3, whose
  // second derivative there is -3/8.
  LagWithin with_middle(double acceleration) const {
    LagWithin better = *this;
    const double found =
        from_.acceleration + (3 * cubic_ + 3 * quartic_ + 2.5 * quintic_) / (h_ * h_);
    better.added_ = (found - acceleration) * h_ * h_ / 0.375;
    return better;
  }
  // The largest that was added, to the lag and to its rate.
  double change() const { return std::abs(added_) / 64; }
  double change_of_rate() const { return std::abs(added_) * kSteepest / h_; }

  // At a share `s` of the step.
  void at(double s, double& lag, double& rate) const {
    const double t = s * h_, within = s * (1 - s);
    lag = from_.lag + t * (from_.rate + t / 2 * from_.acceleration) +
          s * s * s * (cubic_ + s * (quartic_ + s * quintic_)) + added_ * within * within * within;
    rate = from_.rate + t * from_.acceleration +
           s * s * (3 * cubic_ + s * (4 * quartic_ + s * 5 * quintic_)) / h_ +
           added_ * 3 * within * within * (1 - 2 * s) / h_;
  }

 private:
  static constexpr double kSteepest = 0.0536656;  // largest slope of s^3 (1 - s)^3
  End from_;
  double h_, cubic_, quartic_, quintic_;
  double added_ = 0;
};

class Simulation {
 public:
  Simulation(const Case& the_case, const Assumptions& assumptions, const PressureTrace& pressure,
             const SimulationOptions& options, const Progress& progress, std::vector<Piece>* pieces)
      : equations_(the_case, assumptions, pressure),
        options_(options),
        progress_(progress),
        pieces_(pieces),
        tolerance_(std::max(kTightest, options.accuracy.value_or(options.error * kStepShare))),
        scale_(equations_.scales()),
        stepper_(equations_, scale_, tolerance_),
        row_stepper_(equations_, scale_, tolerance_),
        edges_deg_(block_edges_deg(pressure, the_case.pump.geometry.pistons)) {}

  Trajectory run() {
    Trajectory trajectory;
    trajectory.table =
        trajectory_table("analytic", equations_.model().layout(), equations_.drive());
    const std::vector<double> stops = rows();
    trajectory.loads = BodyLoadTable::of(stops.size());
    follow(stops, [&] { add_row(trajectory); });
    trajectory.record = record_;
    return trajectory;
  }

  TrajectoryRecord watch(const ToothForceSink& see) {
    equations_.follow_teeth_alone();
    seen_ = {rows(), see};
    if (!seen_.times.empty()) follow({seen_.times.back()}, [] {});
    return record_;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw ComputationError("analytic model: the simulation stops at " + number_text(time_) +
                           " s: " + why);
  }

  std::vector<double> rows() const {
    return options_.times.empty() ? trajectory_times(equations_.drive()) : options_.times;
  }

  // The whole motion, to every stop.
  template <class At>
  void follow(const std::vector<double>& stops, const At& at_stop) {
    const Stopwatch watch;
    const DriveSpec& drive = equations_.drive();
    y_ = equations_.start(options_);
    start_piece();
    start_teeth();
    if (equations_.walls()) start_walls();
    if (equations_.teeth.pressing != 0) contact_changes(0, equations_.teeth.pressing);
    kinetic_ = equations_.kinetic_energy(0, y_);
    potential_ = potential_energy();
    next_ = drive.duration * kFirstStep;
    note_piece();
    for (const double knot : equations_.knots()) knots_.push_back(knot);
    for (const double stop : stops) {
      while (time_ < stop) {
        const auto knot = std::upper_bound(knots_.begin(), knots_.end(), time_);
        advance(knot != knots_.end() ? std::min(*knot, stop) : stop);
      }
      at_stop();
    }
    close_contact();
    note_piece();
    record_.evaluations = equations_.evaluations();
    record_.seconds = watch.seconds();
    record_.share_out_of_contact = equations_.compliant() ? apart_ / drive.duration : 0;
    record_.choice = "Gragg-Bulirsch-Stoer extrapolation, " + rounded_text(tolerance_) +
                     " per step relative to the scale of each state, for an error of " +
                     rounded_text(options_.error) + " of peak";
  }

  // The interval between edges of pressure in which the block stands, or which it enters.
  void start_piece() {
    if (edges_deg_.empty()) {
      equations_.from_angle = -1e300;
      equations_.to_angle = 1e300;
      return;
    }
    const double angle = equations_.block_angle(time_, y_) / kRadPerDegree;
    turn_ = std::floor(angle / 360);
    const double within = angle - 360 * turn_;
    edge_ = std::upper_bound(edges_deg_.begin(), edges_deg_.end(), within) - edges_deg_.begin();
    set_piece();
    // On an edge, but for the rounding of both: the interval is that which the block enters.
    const double psi = equations_.block_angle(time_, y_);
    const bool above = psi - equations_.from_angle <= Equations::kAtEdge;
    const bool below = equations_.to_angle - psi <= Equations::kAtEdge;
    if (!above && !below) return;
    State dy;
    equations_.rates(time_, y_, dy);
    const Motion m = equations_.motion(time_, y_);
    const bool back = m.block.speed < 0 || (m.block.speed == 0 && m.block.acceleration < 0);
    if (back != above) return;
    edge_ += back ? -1 : 1;
    set_piece();
  }

  double edge_deg(std::ptrdiff_t index) const {
    const auto count = static_cast<std::ptrdiff_t>(edges_deg_.size());
    const std::ptrdiff_t turns = index / count - (index % count < 0 ? 1 : 0);
    return edges_deg_[static_cast<std::size_t>(index - turns * count)] +
           360 * (turn_ + static_cast<double>(turns));
  }

  void set_piece() {
    equations_.from_angle = radians(edge_deg(edge_ - 1));
    equations_.to_angle = radians(edge_deg(edge_));
  }

  // Which flank presses from here on.
  void start_teeth() {
    Teeth& teeth = equations_.teeth;
    teeth = {};
    if (!equations_.compliant() || equations_.walls()) return;
    State dy;
    for (const int flank : {1, -1}) {
      const double x = equations_.approach(y_, flank);
      double rate = equations_.approach_rate(y_, flank);
      if (x < -kOnTouch) continue;
      if (x <= kOnTouch && rate == 0) {
        equations_.rates(time_, y_, dy);  // without force
        rate = flank * dy[kLagRate];
      }
      if (x <= kOnTouch && rate <= 0) continue;
      if (1 + equations_.law().dissipation * equations_.approach_rate(y_, flank) > 0)
        teeth.pressing = flank;
      else
        teeth.idle = flank;
      return;
    }
  }

  // How every piston stands to its wall from here on.
  void start_walls() {
    auto& modes = equations_.wall_modes;
    std::fill(modes.begin(), modes.end(), WallMode::away);
    State dy;
    equations_.rates(time_, y_, dy);
    const std::vector<WallPath>& paths = equations_.wall_paths(time_, y_);
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const WallPath& path = paths[k];
      if (path.distance > kOnTouch || (path.distance >= -kOnTouch && path.rate > 0))
        if (1 + equations_.walls()->dissipation() * path.rate > 0) {
          modes[k] = WallMode::pressing;
          wall_changes(k, true, path.rate);
        }
    }
    inside_.assign(modes.size(), false);
    for (std::size_t k = 0; k < modes.size(); ++k)
      inside_[k] = modes[k] == WallMode::pressing || paths[k].distance > kOnTouch;
  }

  struct EventFunctions {
    // The two ends of an interval; of the teeth or of each wall two more.
    std::array<EventFunction, 2 + 2 * kMaxPistons> all;
    std::size_t count = 0;
    void add(double value, double rate) { all[count++] = {value, rate}; }
  };

  // Of each piston two: touching or leaving its wall, and the end or start of its push within. To
  // be asked for right after the rates there.
  void add_wall_functions(double time, const State& y, EventFunctions& g) {
    const double dissipation = equations_.walls()->dissipation();
    const std::vector<WallPath>& paths = equations_.wall_paths(time, y);
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const WallPath& path = paths[k];
      if (!inside_[k]) {
        g.add(path.distance, path.rate);
        g.add(-1, 0);
        continue;
      }
      g.add(-path.distance, -path.rate);
      const int sign = equations_.wall_modes[k] == WallMode::pressing ? -1 : 1;
      g.add(sign * (1 + dissipation * path.rate), sign * dissipation * path.rate_dot);
    }
  }

  // Of the present time, state and law.
  struct Present {
    State dy = {};
    EventFunctions functions;
    bool known = false;
  };

  // In an order that handle() knows: the interval's two ends, then the teeth.
  EventFunctions event_functions(double time, const State& y, const State& dy) {
    EventFunctions g;
    const double psi = equations_.block_angle(time, y);
    const Equations& e = equations_;
    const double psi_rate = block_speed(time, y);
    g.add(psi - e.to_angle, psi_rate);
    g.add(e.from_angle - psi, -psi_rate);
    if (!e.compliant()) return g;
    if (e.walls()) {
      add_wall_functions(time, y, g);
      return g;
    }
    const int within = e.teeth.pressing + e.teeth.idle;
    if (within == 0) {
      g.add(e.approach(y, 1), e.approach_rate(y, 1));
      g.add(e.approach(y, -1), e.approach_rate(y, -1));
    } else {
      g.add(-e.approach(y, within), -e.approach_rate(y, within));
      const double push = 1 + e.law().dissipation * e.approach_rate(y, within);
      const double push_rate = e.law().dissipation * within * e.law().arm * dy[kLagRate];
      if (e.teeth.pressing != 0)
        g.add(-push, -push_rate);
      else
        g.add(push, push_rate);
    }
    return g;
  }

  double block_speed(double time, const State& y) const { return equations_.block_speed(time, y); }

  double nearness(std::size_t guard, double time) const {
    if (guard < 2) return kOnEdge * (std::abs(equations_.block_angle(time, y_)) + 2 * kPi);
    // A wall's approach is a difference of lengths of some centimetres.
    if (equations_.walls()) return guard % 2 == 1 ? 1e-12 : kOnWall;
    return guard == 3 && equations_.teeth.pressing + equations_.teeth.idle != 0 ? 1e-12 : kOnTouch;
  }

  // One step, to an event or to `stop` at most.
  void advance(double stop) {
    if (progress_) progress_(std::min(1.0, time_ / equations_.drive().duration));
    if (equations_.evaluations() > kMaxEvaluations)
      fail("after " + std::to_string(kMaxEvaluations) +
           " evaluations: the motion is too fast for the simulated time; shorten it (duration_s) "
           "or allow a larger error");
    State out, out_dy;
    if (!present_.known) {
      equations_.rates(time_, y_, present_.dy);
      present_.functions = event_functions(time_, y_, present_.dy);
      present_.known = true;
    }
    const State& dy = present_.dy;
    const EventFunctions& before = present_.functions;
    for (std::size_t i = 0; i < before.count; ++i)
      if (before.all[i].rate > 0 && before.all[i].value > -nearness(i, time_)) {
        handle(i);
        present_.known = false;
        note_piece();
        return;
      }
    double h = std::min(next_, stop - time_);
    // An event of which the rate says that it comes within this step: the pieces beyond it are
    // another law, which the step need not see.
    for (std::size_t i = 0; i < 2; ++i)
      if (before.all[i].rate > 0) {
        const double ahead = -before.all[i].value / before.all[i].rate;
        if (ahead > 0) h = std::min(h, ahead * (1 + 1e-6));
      }
    h = std::min(h, longest_before_leaving(dy));
    double taken = h;
    double proposal = h;
    if (!stepper_.attempt(time_, y_, dy, proposal, out)) {
      shrink(taken, proposal);
      return;
    }
    ++record_.steps;
    const double free_proposal = proposal;
    if (law_is_new_ && h >= next_) note_first_step(taken);
    equations_.rates(time_ + taken, out, out_dy);
    EventFunctions after = event_functions(time_ + taken, out, out_dy);
    std::size_t event = after.count;
    double when = taken;
    for (std::size_t i = 0; i < after.count; ++i) {
      const double t = first_above(before.all[i], after.all[i], taken);
      if (t <= when && (t < when || event == after.count)) {
        event = i;
        when = t;
      }
    }
    if (event < after.count) {
      // To the event itself: false position between a time before and one after it.
      double low = 0, high = taken;
      bool landed = std::abs(after.all[event].value) <= nearness(event, time_) && when == taken;
      for (int tries = 0; !landed; ++tries) {
        constexpr int kMaxTries = 60;
        if (tries == kMaxTries) fail("an event cannot be located");
        proposal = taken = when;
        if (!stepper_.attempt(time_, y_, dy, proposal, out)) {
          shrink(taken, proposal);
          return;
        }
        ++record_.steps;
        equations_.rates(time_ + taken, out, out_dy);
        after = event_functions(time_ + taken, out, out_dy);
        const EventFunction& g = after.all[event];
        if (std::abs(g.value) <= nearness(event, time_)) break;
        (g.value > 0 ? high : low) = taken;
        if (high - low <= 2e-16 * (time_ + high)) break;
        when = g.rate != 0 ? taken - g.value / g.rate : low;
        if (!(when > low && when < high)) when = (low + high) / 2;
      }
    }
    // A step that was cut short says little of what the next may be.
    if (h < next_)
      next_ = std::max(next_, free_proposal);
    else
      next_ = free_proposal;
    if (equations_.compliant() && is_apart()) apart_ += taken;
    const double end = taken == stop - time_ ? stop : time_ + taken;
    see_within({time_, y_, dy}, {end, out, out_dy});
    time_ = end;
    y_ = out;
    present_ = {out_dy, after, true};
    if (taken > smallest_step())
      at_once_ = 0;
    else
      count_at_once();
    if (event < after.count) {
      handle(event);
      present_.known = false;
      note_piece();
    }
  }

  struct Moment {
    double time;
    State y, dy;
    LagWithin::End lag() const { return {y[kLag], y[kLagRate], dy[kLagRate]}; }
  };

  // Rows within a step or a part of it, which do not end it: lag and rate are those of the
  // polynomial of degree 6 that has lag, rate and acceleration of both ends and the acceleration in
  // the middle. It is taken where the middle changes that of degree 5 by little; the next
  // acceleration would change it by a tenth of that or less, as long as a step is a third of a
  // swing or less. Else each half has one of its own.
  void see_within(const Moment& from, const Moment& to) {
    constexpr double kNextChange = 0.1;
    const auto waiting = [&] {
      return seen_.next < seen_.times.size() && seen_.times[seen_.next] <= to.time;
    };
    if (!waiting()) return;
    const double h = to.time - from.time;
    Moment there{from.time + h / 2, from.y, {}};
    const LagWithin lag(from.lag(), to.lag(), h);
    lag.at(0.5, there.y[kLag], there.y[kLagRate]);
    equations_.rates(there.time, there.y, there.dy);
    const LagWithin better = lag.with_middle(there.dy[kLagRate]);
    const double allowed = options_.error / kNextChange;
    if (better.change() > allowed * scale_[kLag] ||
        better.change_of_rate() > allowed * scale_[kLagRate]) {
      if (h < smallest_step()) fail("rows within a step cannot be found");
      there = moved(from, there.time);
      see_within(from, there);
      see_within(there, to);
      return;
    }
    for (; waiting(); ++seen_.next) {
      const double time = seen_.times[seen_.next];
      better.at((time - from.time) / h, there.y[kLag], there.y[kLagRate]);
      seen_.sink(time, equations_.tooth_force(there.y));
    }
  }

  // By steps that nothing else depends on.
  Moment moved(Moment from, double time) {
    State out;
    double h = time - from.time;
    while (from.time < time) {
      const double asked = h = std::min(h, time - from.time);
      if (row_stepper_.attempt(from.time, from.y, from.dy, h, out)) {
        from.time = asked == time - from.time ? time : from.time + asked;
        from.y = out;
        equations_.rates(from.time, from.y, from.dy);
      } else {
        h = std::min(h, asked / 2);
        if (h < smallest_step())
          fail("the motion changes too fast there: the step falls below round-off");
      }
    }
    return from;
  }

  double potential_energy() {
    return equations_.potential_energy(y_) + equations_.wall_energy(time_, y_);
  }

  bool is_apart() const {
    const auto& modes = equations_.wall_modes;
    return equations_.walls()
               ? std::find(modes.begin(), modes.end(), WallMode::pressing) == modes.end()
               : equations_.teeth.pressing == 0;
  }

  void note_piece() {
    if (pieces_ != nullptr)
      pieces_->push_back({time_, y_, equations_.teeth, equations_.from_angle, equations_.to_angle});
  }

  // A force like x^1.5 is not smooth where the flank leaves, and steps to there fail: they come
  // nearer by a share of what is left, until all the force that is left is no error.
  double longest_before_leaving(const State& dy) const {
    constexpr double kShareOfWay = 0.8, kErrorOfForce = 0.05;
    const int flank = equations_.teeth.pressing;
    if (flank == 0 || equations_.law().exponent == 1) return HUGE_VAL;
    // Where x + v t + a t^2 / 2 passes 0.
    const double x = equations_.approach(y_, flank), v = equations_.approach_rate(y_, flank);
    const double a = flank * equations_.law().arm * dy[kLagRate];
    const double root = std::sqrt(v * v - 2 * a * x);
    const double left = v > 0 && a < 0 ? -(v + root) / a : 2 * x / (root - v);
    const double lost = kErrorOfForce * equations_.tooth_acceleration(y_) * left;
    return left > 0 && lost > tolerance_ * scale_[kLagRate] ? kShareOfWay * left : HUGE_VAL;
  }

  // A flank touches or leaves: the first step is that which the last motion of this kind began
  // with, a little more if it was taken at once.
  void begin_law() {
    law_is_new_ = true;
    first_failed_ = false;
    if (const double first = first_steps_[is_apart() ? 0 : 1]; first > 0) next_ = first;
  }
  void note_first_step(double taken) {
    constexpr double kMore = 1.5;
    law_is_new_ = false;
    first_steps_[is_apart() ? 0 : 1] = first_failed_ ? taken : kMore * taken;
  }

  void shrink(double taken, double proposal) {
    first_failed_ = true;
    next_ = std::min(proposal, taken / 2);
    if (next_ < smallest_step())
      fail("the motion changes too fast there: the step falls below round-off");
  }

  double smallest_step() const {
    return kSmallestStep * std::min(1.0, equations_.drive().duration);
  }

  void count_at_once() {
    if (++at_once_ > kMaxEventsAtOnce)
      fail("events of teeth and pressure edges repeat without any motion");
  }

  // What changes at an event.
  void handle(std::size_t guard) {
    count_at_once();
    if (guard < 2) {
      edge_ += guard == 0 ? 1 : -1;
      set_piece();
      return;
    }
    if (equations_.walls()) {
      change_wall((guard - 2) / 2, guard % 2 == 0);
      return;
    }
    const bool was_apart = is_apart();
    const Teeth was = equations_.teeth;
    const int within = was.pressing + was.idle;
    Teeth& teeth = equations_.teeth;
    if (within == 0) {
      const int flank = guard == 2 ? 1 : -1;
      y_[kLag] = flank * equations_.law().half_backlash / equations_.law().arm;
      const bool pushes =
          1 + equations_.law().dissipation * equations_.approach_rate(y_, flank) > 0;
      (pushes ? teeth.pressing : teeth.idle) = flank;
    } else if (guard == 2) {
      y_[kLag] = within * equations_.law().half_backlash / equations_.law().arm;
      teeth = {};
    } else {
      std::swap(teeth.pressing, teeth.idle);
    }
    if (was.pressing != teeth.pressing) contact_changes(was.pressing, teeth.pressing);
    if (is_apart() != was_apart) begin_law();
  }

  // A piston passes the end of contact, or its push ends or starts within.
  void change_wall(std::size_t piston, bool passes) {
    const WallPath path = equations_.wall_paths(time_, y_)[piston];
    WallMode& mode = equations_.wall_modes[piston];
    const bool pressed = mode == WallMode::pressing;
    if (passes) inside_[piston] = !inside_[piston];
    const bool pushes = inside_[piston] &&
                        (passes ? 1 + equations_.walls()->dissipation() * path.rate > 0 : !pressed);
    mode = pushes ? WallMode::pressing : WallMode::away;
    if (pushes != pressed) wall_changes(piston, pushes, path.rate);
  }

  void wall_changes(std::size_t piston, bool touch, double approach_speed) {
    if (record_.events.size() >= kMaxEvents)
      fail("after " + std::to_string(kMaxEvents) + " touches of the pistons");
    ToothEvent event;
    event.time_s = time_;
    event.touch = touch;
    event.flank = y_[kLag] < 0 ? -1 : 1;
    event.piston = static_cast<int>(piston) + 1;
    event.shaft_speed = equations_.speed(time_, y_);
    event.block_speed = block_speed(time_, y_);
    event.approach_speed = approach_speed;
    record_.events.push_back(event);
  }

  void contact_changes(int from, int to) {
    if (record_.events.size() >= kMaxEvents)
      fail("after " + std::to_string(kMaxEvents) + " touches of the teeth");
    if (from != 0) close_contact();
    ToothEvent event;
    event.time_s = time_;
    event.touch = to != 0;
    event.flank = to != 0 ? to : from;
    event.shaft_speed = equations_.speed(time_, y_);
    event.block_speed = block_speed(time_, y_);
    event.approach_speed = equations_.approach_rate(y_, event.flank);
    if (to != 0) {
      touch_ = record_.events.size();
      y_[kImpulse] = 0;
    }
    record_.events.push_back(event);
  }

  // The flank that pressed has left: its impulse is known.
  void close_contact() {
    if (touch_ < record_.events.size()) record_.events[touch_].impulse = y_[kImpulse];
    touch_ = kNone;
  }

  void add_row(Trajectory& trajectory) {
    Motion m = equations_.motion(time_, y_);
    equations_.at_own_angle(time_, y_);
    MotionChecks checks{};
    std::vector<double> state;
    equations_.row(time_, y_, m, state, row_, checks);
    append_trajectory_row(trajectory.table, state, row_, checks);
    if (options_.body_loads) trajectory.loads.append(equations_.body_loads());
    trajectory.lag.push_back(y_[kLag]);

    record_.work_of_loads = y_[kWorkOfLoads];
    record_.work_of_drives = y_[kWorkOfDrive];
    record_.kinetic_energy_gained = equations_.kinetic_energy(time_, y_) - kinetic_;
    record_.potential_energy_gained = potential_energy() - potential_;
    record_.work_residual = record_.work_of_loads + record_.work_of_drives -
                            record_.kinetic_energy_gained - record_.potential_energy_gained;
    update_max_abs(record_.worst_work_residual, record_.work_residual);
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  Equations equations_;
  const SimulationOptions options_;
  const Progress& progress_;
  std::vector<Piece>* pieces_;
  double tolerance_;
  State scale_;
  Stepper stepper_, row_stepper_;
  std::vector<double> edges_deg_, knots_, row_;
  double turn_ = 0;
  std::ptrdiff_t edge_ = 0;  // that ends the interval
  double time_ = 0, next_ = 0, apart_ = 0, kinetic_ = 0, potential_ = 0;
  State y_ = {};
  Present present_;
  struct Seen {
    std::vector<double> times;
    ToothForceSink sink;
    std::size_t next = 0;
  };
  Seen seen_;  // rows that do not end a step
  // Of motion without and with a flank that presses, s; 0: not known yet.
  std::array<double, 2> first_steps_ = {};
  bool law_is_new_ = false, first_failed_ = false;
  int at_once_ = 0;
  std::size_t touch_ = kNone;
  std::vector<bool> inside_;  // which pistons are within their walls
  TrajectoryRecord record_;
};

}  // namespace

namespace {

const Case& without_teeth(const Case& the_case) {
  if (the_case.pump.gear.contact == ToothContact::teeth)
    throw InputError(
        "analytic model: [gear] contact = \"teeth\": motion with teeth is integrated from the "
        "equations of motion (analytic/mechanics.h)");
  return the_case;
}

}  // namespace

Trajectory simulate(const Case& the_case, const Assumptions& assumptions,
                    const PressureTrace& pressure, const SimulationOptions& options,
                    std::vector<Piece>& pieces) {
  return Simulation(without_teeth(the_case), assumptions, pressure, options, {}, &pieces).run();
}

}  // namespace simulation

Trajectory simulate(const Case& the_case, const Assumptions& assumptions,
                    const PressureTrace& pressure, const SimulationOptions& options,
                    const Progress& progress) {
  return simulation::Simulation(simulation::without_teeth(the_case), assumptions, pressure, options,
                                progress, nullptr)
      .run();
}

TrajectoryRecord watch_tooth_force(const Case& the_case, const Assumptions& assumptions,
                                   const PressureTrace& pressure, const SimulationOptions& options,
                                   const ToothForceSink& see) {
  if (the_case.pump.gear.contact != ToothContact::compliant ||
      the_case.pump.transfer.kind != TransferKind::gear)
    throw InputError("[gear] contact: must be \"compliant\" where a tooth force is watched");
  if (drive_of(the_case).kind != DriveKind::speed)
    throw InputError("[drive] kind: must be \"speed\" where a tooth force is watched");
  return simulation::Simulation(the_case, assumptions, pressure, options, {}, nullptr).watch(see);
}

}  // namespace bentaxis::analytic

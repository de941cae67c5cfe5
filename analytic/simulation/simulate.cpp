// Steps through the motion: to every event, to every row.
#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/results/stopwatch.h"
#include "simulation/events.h"
#include "simulation/pieces.h"
#include "simulation/stepper.h"

namespace bentaxis::analytic {
namespace simulation {
namespace {

// Tolerance of a step, of the scales of the states, for a wanted error of the reactions: what
// remains is for the growth of errors over the motion.
constexpr double kStepShare = 1e-3;
constexpr double kTightest = 1e-14;
constexpr double kSmallestStep = 1e-14;      // of the duration, or of a second if that is less
constexpr double kFirstStep = 1e-3;          // of the duration, at most
constexpr long kMaxEvaluations = 100000000;  // of the closed form: some minutes
constexpr int kMaxEventsAtOnce = 64;         // without a step between them
constexpr std::size_t kEnds = 2;             // of the interval, first of the event functions

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
        interval_(equations_, pressure, the_case.pump.geometry.pistons),
        contacts_(equations_) {}

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
  [[noreturn]] void fail(const std::string& why) const { stop_simulation(time_, why); }

  std::vector<double> rows() const {
    return options_.times.empty() ? trajectory_times(equations_.drive()) : options_.times;
  }

  // The whole motion, to every stop.
  template <class At>
  void follow(const std::vector<double>& stops, const At& at_stop) {
    const Stopwatch watch;
    const DriveSpec& drive = equations_.drive();
    y_ = equations_.start(options_);
    interval_.start(time_, y_);
    contacts_.start(time_, y_);
    kinetic_ = equations_.kinetic_energy(0, y_);
    potential_ = potential_energy();
    next_ = drive.duration * kFirstStep;
    note_piece();
    for (const double breakpoint : equations_.breakpoints()) breakpoints_.push_back(breakpoint);
    for (const double stop : stops) {
      while (time_ < stop) {
        const auto breakpoint = std::upper_bound(breakpoints_.begin(), breakpoints_.end(), time_);
        advance(breakpoint != breakpoints_.end() ? std::min(*breakpoint, stop) : stop);
      }
      at_stop();
    }
    contacts_.close(y_);
    record_.events = contacts_.events();
    note_piece();
    record_.evaluations = equations_.evaluations();
    record_.seconds = watch.seconds();
    record_.share_out_of_contact = equations_.compliant() ? apart_ / drive.duration : 0;
    record_.choice = "Gragg-Bulirsch-Stoer extrapolation, " + rounded_text(tolerance_) +
                     " per step relative to the scale of each state, for an error of " +
                     rounded_text(options_.error) + " of peak";
  }

  // Of the present time, state and law.
  struct Present {
    State dy = {};
    EventFunctions functions;
    bool known = false;
  };

  // The interval's two ends, then the contacts.
  EventFunctions event_functions(double time, const State& y, const State& dy) const {
    EventFunctions g;
    interval_.add_functions(time, y, g);
    contacts_.add_functions(time, y, dy, g);
    return g;
  }

  double nearness(std::size_t function) const {
    return function < kEnds ? interval_.nearness(time_, y_) : contacts_.nearness(function - kEnds);
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
      if (before.all[i].rate > 0 && before.all[i].value > -nearness(i)) {
        handle(i);
        present_.known = false;
        note_piece();
        return;
      }
    double h = std::min(next_, stop - time_);
    // An event of which the rate says that it comes within this step: the pieces beyond it are
    // another law, which the step need not see.
    for (std::size_t i = 0; i < kEnds; ++i)
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
      bool landed = std::abs(after.all[event].value) <= nearness(event) && when == taken;
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
        if (std::abs(g.value) <= nearness(event)) break;
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
    if (equations_.compliant() && contacts_.is_apart()) apart_ += taken;
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
    if (const double first = first_steps_[contacts_.is_apart() ? 0 : 1]; first > 0) next_ = first;
  }
  void note_first_step(double taken) {
    constexpr double kMore = 1.5;
    law_is_new_ = false;
    first_steps_[contacts_.is_apart() ? 0 : 1] = first_failed_ ? taken : kMore * taken;
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
  void handle(std::size_t function) {
    count_at_once();
    if (function < kEnds)
      interval_.pass(function == 0);
    else if (contacts_.change(function - kEnds, time_, y_))
      begin_law();
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

  Equations equations_;
  const SimulationOptions options_;
  const Progress& progress_;
  std::vector<Piece>* pieces_;
  double tolerance_;
  State scale_;
  Stepper stepper_, row_stepper_;
  PressureInterval interval_;
  Contacts contacts_;
  std::vector<double> breakpoints_, row_;
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
  TrajectoryRecord record_;
};

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

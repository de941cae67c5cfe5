// Kahraman and Singh's oscillator with backlash: exactly by matching pieces, and by coupled/.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>

#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/pump/units.h"
#include "numbers.h"

namespace bentaxis::external {
namespace {

/// x'' + 2 damping x' + f(x) = mean + swing W^2 sin(W t), f the dead band between -1 and 1.
struct Equation {
  double damping = 0.05, mean = 0.1, swing = 0.05, frequency = 1;
  double period() const { return 2 * kPi / frequency; }
};

struct State {
  double x = 1, v = 0;
};
using Matrix = std::array<double, 4>;  // row by row

Matrix times(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

// ---- exactly -----------------------------------------------------------------------------------

/// The solution while x stays on one side of the corners: side 1, 0 or -1.
class Piece {
 public:
  Piece(const Equation& of, int side, double start, const State& from)
      : of_(of), side_(side), start_(start) {
    const double w = of.frequency, force = of.swing * w * w, z = 2 * of.damping * w;
    const double direct = side == 0 ? -w * w : 1 - w * w;
    sine_ = force * direct / (direct * direct + z * z);
    cosine_ = -force * z / (direct * direct + z * z);
    const State forced = particular(start);
    left_ = {from.x - forced.x, from.v - forced.v};
  }

  State at(double time) const {
    const State forced = particular(time);
    const Matrix m = transition(time - start_);
    return {forced.x + m[0] * left_.x + m[1] * left_.v, forced.v + m[2] * left_.x + m[3] * left_.v};
  }
  /// d state(start + way) / d state(start).
  Matrix transition(double way) const {
    const double z = of_.damping;
    if (side_ == 0) {
      const double decay = std::exp(-2 * z * way);
      return {1, (1 - decay) / (2 * z), 0, decay};
    }
    const double w = std::sqrt(1 - z * z), decay = std::exp(-z * way);
    const double c = decay * std::cos(w * way), s = decay * std::sin(w * way) / w;
    return {c + z * s, s, -s, c - z * s};
  }

 private:
  State particular(double time) const {
    const double w = of_.frequency, s = std::sin(w * time), c = std::cos(w * time);
    State to{sine_ * s + cosine_ * c, w * (sine_ * c - cosine_ * s)};
    if (side_ == 0) {
      const double drift = of_.mean / (2 * of_.damping);
      to.x += drift * (time - start_);
      to.v += drift;
    } else {
      to.x += side_ + of_.mean;
    }
    return to;
  }

  Equation of_;
  int side_;
  double start_;
  double sine_ = 0, cosine_ = 0;
  State left_;
};

struct Corner {
  double time = 0;
  bool touch = false;
  int flank = 1;
};

/// What a motion has shown.
struct Seen {
  std::vector<Corner> corners;
  double least = HUGE_VAL, greatest = -HUGE_VAL;
  void add(double x) {
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
};

template <typename F>
double root(const F& f, double low, double high) {  // f changes sign
  const bool rising = f(high) > f(low);
  for (int i = 0; i < 200 && high > std::nextafter(low, high); ++i) {
    const double middle = low + (high - low) / 2;
    (rising == (f(middle) > 0) ? high : low) = middle;
    if (middle == low && middle == high) break;
  }
  return high;
}

class Exact {
 public:
  Exact(const Equation& of, const State& from) : of_(of), state_(from) {
    // On a corner at rest it goes where the mean force pulls.
    const double going = from.v != 0 ? from.v : of.mean;
    if (from.x > 1 || (from.x == 1 && going > 0)) side_ = 1;
    if (from.x < -1 || (from.x == -1 && going < 0)) side_ = -1;
  }

  const State& state() const { return state_; }
  const Matrix& derivative() const { return derivative_; }  ///< of the state by the first one

  /// Up to a time; `each` is called with times between and the piece that is valid there.
  template <typename Each>
  void advance(double end, Seen& seen, const Each& each) {
    const double step = of_.period() / 400;
    while (time_ < end) {
      const Piece now = piece();
      const double from = time_;
      double low = from;
      double corner = -1;
      for (long i = 1; corner < 0 && low < end; ++i) {
        const double high = std::min(end, from + static_cast<double>(i) * step);
        corner = leaves(now, low, high, i == 1);
        if (corner < 0) {
          each(low, high, now);
          seen.add(now.at(high).x);
          low = high;
        } else {
          each(low, corner, now);
        }
      }
      const double to = corner < 0 ? end : corner;
      // Extremes are where the velocity vanishes.
      const auto speed = [&](double t) { return now.at(t).v; };
      for (double a = from; a < to; a += step) {
        const double b = std::min(to, a + step);
        if (speed(a) * speed(b) < 0) seen.add(now.at(root(speed, a, b)).x);
      }
      derivative_ = times(now.transition(to - from), derivative_);
      state_ = now.at(to);
      time_ = to;
      if (corner < 0) return;
      const int before = side_;
      state_.x = state_.x > 0 ? 1 : -1;
      side_ = before == 0 ? (state_.x > 0 ? 1 : -1) : 0;
      seen.corners.push_back({time_, before == 0, before == 0 ? side_ : before});
    }
  }
  void advance(double end, Seen& seen) {
    advance(end, seen, [](double, double, const Piece&) {});
  }

 private:
  Piece piece() const { return {of_, side_, time_, state_}; }

  /// Where the solution leaves its side between two times; -1: it does not.
  double leaves(const Piece& now, double low, double high, bool first) const {
    for (const int corner : {1, -1}) {
      if (side_ == -corner) continue;
      // > 0 on this side
      const double sign = side_ == 0 ? -corner : corner;
      const auto inside = [&](double t) { return sign * (now.at(t).x - corner); };
      const auto speed = [&](double t) { return sign * now.at(t).v; };
      double from = low;
      if (first && inside(low) <= 0) {  // it starts on the corner and goes inside
        if (inside(high) > 0) continue;
        // There and back within the step: from the farthest point.
        if (speed(low) <= 0 || speed(high) >= 0) continue;
        from = root([&](double t) { return -speed(t); }, low, high);
      }
      if (inside(high) <= 0) return root([&](double t) { return -inside(t); }, from, high);
      if (speed(from) < 0 && speed(high) > 0) {
        const double nearest = root(speed, from, high);
        if (inside(nearest) < 0) return root([&](double t) { return -inside(t); }, from, nearest);
      }
    }
    return -1;
  }

  Equation of_;
  State state_;
  double time_ = 0;
  int side_ = 0;
  Matrix derivative_ = {1, 0, 0, 1};
};

struct Periodic {
  State state;
  double largest_multiplier = 0;
};

/// Newton's method on the map of a period, from a state after many of them.
Periodic exact_periodic(const Equation& of, State at) {
  Matrix m{};
  for (int i = 0; i < 20; ++i) {
    Exact motion(of, at);
    Seen seen;
    motion.advance(of.period(), seen);
    m = motion.derivative();
    const double rx = motion.state().x - at.x, rv = motion.state().v - at.v;
    const double a = 1 - m[0], b = -m[1], c = -m[2], d = 1 - m[3], det = a * d - b * c;
    at.x += (d * rx - b * rv) / det;
    at.v += (a * rv - c * rx) / det;
    if (std::hypot(rx, rv) < 1e-15) break;
  }
  const double trace = m[0] + m[3], det = m[0] * m[3] - m[1] * m[2];
  const std::complex<double> root = std::sqrt(std::complex<double>(trace * trace / 4 - det));
  return {at, std::max(std::abs(trace / 2 + root), std::abs(trace / 2 - root))};
}

// ---- by the integrator of the pump's motion
// ------------------------------------------------------

constexpr int kPistons = 5;  // the period of coupled::steady is a fifth of a turn

/// The equation as that of a gear's lag; the block turns steadily by a fifth of a turn per period.
class Oscillator : public Mechanics {
 public:
  Oscillator(const Equation& of, const State& from) : of_(of), from_(from) {}

  const ChannelLayout& layout() const override { return layout_; }
  MotionVector start() const override {
    MotionVector y{};
    y[kLag] = from_.x;
    y[kLagRate] = from_.v;
    return y;
  }
  MotionVector scales() const override {
    MotionVector s;
    s.fill(0.1);  // what the force is, and so the play beyond a corner
    return s;
  }
  bool shaft_is_free() const override { return false; }
  bool compliant() const override { return true; }
  bool has_motor() const override { return false; }
  std::vector<double> breakpoints() const override { return {}; }
  AxisMotion shaft(double time, const MotionVector&) const override {
    return {of_.frequency / kPistons * time, of_.frequency / kPistons, 0};
  }
  AxisMotion block(double time, const MotionVector& y) const override { return shaft(time, y); }
  double approach(double, const MotionVector& y, int flank) const override {
    return flank * y[kLag] - 1;
  }
  double approach_rate(double, const MotionVector& y, int flank) const override {
    return flank * y[kLagRate];
  }
  void rates(double time, const MotionVector& y, const OilLoads&, MotionVector& dy) override {
    dy.fill(0);
    const double w = of_.frequency;
    dy[kLag] = y[kLagRate];
    dy[kLagRate] =
        of_.mean + of_.swing * w * w * std::sin(w * time) - 2 * of_.damping * y[kLagRate];
    for (const int flank : {1, -1}) {
      const double force = std::max(0.0, approach(time, y, flank));
      dy[kLagRate] -= flank * force;
      dy[kImpulse] += force;
    }
  }
  double pressure_power(double, const MotionVector&, const OilLoads&) override { return 0; }
  void row(double time, const MotionVector& y, const OilLoads&, std::vector<double>& state,
           std::vector<double>& row, MotionChecks& checks) override {
    // Speeds carry the rate of the lag, for whoever reads the table.
    state = {time, 0, 0, 0, y[kLagRate]};
    row.assign(layout_.size(), not_computed());
    checks = {};
  }
  double kinetic_energy(double, const MotionVector& y) override {
    return y[kLagRate] * y[kLagRate] / 2;
  }
  double potential_energy(const MotionVector&) const override { return 0; }

 private:
  Equation of_;
  State from_;
  ChannelLayout layout_{kPistons};
};

class Integrated {
 public:
  Integrated() : pressure_(spec()), oil_(coupled::prescribed_oil(kPistons, pressure_, {})) {}

  Trajectory run(const Equation& of, const State& from, double periods, int samples) const {
    Oscillator mechanics(of, from);
    coupled::Options options = within();
    for (int i = 0; i <= samples; ++i) options.times.push_back(of.period() * periods * i / samples);
    return coupled::simulate("oscillator", mechanics, *oil_, drive(), options);
  }
  coupled::SteadyMotion steady(const Equation& of, const State& from) const {
    Oscillator mechanics(of, from);
    return coupled::steady("oscillator", mechanics, *oil_, drive(), within());
  }

 private:
  static PressureSpec spec() {
    PressureSpec to;
    to.transition_deg = 20;
    return to;
  }
  static DriveSpec drive() {
    DriveSpec to;
    to.duration = 1e3;
    to.samples = 10;
    return to;
  }
  static coupled::Options within() {
    coupled::Options to;
    to.tolerance = 1e-11;
    return to;
  }

  PressureTrace pressure_;
  std::unique_ptr<Oil> oil_;
};

State last_state(const Trajectory& t) { return {t.lag.back(), t.table.state(t.lag.size() - 1, 4)}; }

/// 0: touches always, 1: loses contact, 2: hits both flanks; of a last period.
int class_of(double least, double greatest) {
  if (least > 1 || greatest < -1) return 0;
  return least < -1 && greatest > 1 ? 2 : 1;
}

std::string at_text(double frequency) {
  char text[32];
  std::snprintf(text, sizeof text, "oscillator.W_%.1f.", frequency);
  return text;
}

void compare_waveform(const Integrated& integrated, Numbers& numbers) {
  constexpr int kPeriods = 20, kSamples = 2000;
  for (const double frequency : {0.5, 0.8, 1.2}) {
    Equation of;
    of.frequency = frequency;
    const Trajectory found = integrated.run(of, {}, kPeriods, kSamples);
    Exact motion(of, {});
    Seen seen;
    double worst = 0;
    std::size_t next = 0;
    const double sample = of.period() * kPeriods / kSamples;
    motion.advance(of.period() * kPeriods, seen, [&](double, double to, const Piece& piece) {
      for (; next < found.lag.size() && static_cast<double>(next) * sample <= to; ++next)
        worst = std::max(
            worst, std::abs(piece.at(static_cast<double>(next) * sample).x - found.lag[next]));
    });
    if (next + 1 < found.lag.size()) worst = HUGE_VAL;  // it did not come to the end
    const std::string where = at_text(frequency);
    numbers.push_back({where + "waveform", worst});
    // The start at x = 1 is a touch for one and none for the other: from the first moment on.
    std::vector<Corner> events;
    for (const ToothEvent& event : found.record.events)
      if (event.time_s > 0) events.push_back({event.time_s, event.touch, event.flank});
    numbers.push_back(
        {where + "events_missed",
         std::abs(static_cast<double>(events.size()) - static_cast<double>(seen.corners.size()))});
    double apart = events.size() == seen.corners.size() ? 0 : HUGE_VAL;
    for (std::size_t i = 0; i < std::min(events.size(), seen.corners.size()); ++i) {
      apart = std::max(apart, std::abs(events[i].time - seen.corners[i].time));
      if (events[i].touch != seen.corners[i].touch || events[i].flank != seen.corners[i].flank)
        apart = HUGE_VAL;
    }
    numbers.push_back({where + "event_times", apart / of.period()});
  }
}

struct Branch {
  std::vector<double> frequency, least, greatest;
};

template <typename Run>  // state after 60 periods from a state; extremes of the last one
Branch follow(const std::vector<double>& frequencies, const Run& run) {
  Branch branch;
  State at;
  for (const double frequency : frequencies) {
    Equation of;
    of.frequency = frequency;
    Seen last;
    at = run(of, at, last);
    branch.frequency.push_back(frequency);
    branch.least.push_back(last.least);
    branch.greatest.push_back(last.greatest);
  }
  return branch;
}

void compare_branches(const Integrated& integrated, Numbers& numbers) {
  std::vector<double> up;
  for (int i = 0; i <= 16; ++i) up.push_back(0.40 + 0.05 * i);
  const std::vector<double> down(up.rbegin(), up.rend());
  constexpr int kPeriods = 60, kSamples = 2000;
  const auto exactly = [](const Equation& of, const State& from, Seen& last) {
    Exact motion(of, from);
    Seen before;
    motion.advance(of.period() * (kPeriods - 1), before);
    motion.advance(of.period() * kPeriods, last);
    return motion.state();
  };
  const auto by_integrator = [&](const Equation& of, const State& from, Seen& last) {
    const State before = last_state(integrated.run(of, from, kPeriods - 1, 1));
    const Trajectory t = integrated.run(of, before, 1, kSamples);
    for (std::size_t i = 1; i + 1 < t.lag.size(); ++i) {
      last.add(t.lag[i]);
      // The parabola through three samples at its vertex.
      const double a = t.lag[i - 1], b = t.lag[i], c = t.lag[i + 1];
      const double bend = a - 2 * b + c, shift = bend == 0 ? 1 : (a - c) / (2 * bend);
      if (std::abs(shift) <= 0.5) last.add(b - (a - c) * (a - c) / (8 * bend));
    }
    last.add(t.lag.front());
    last.add(t.lag.back());
    return last_state(t);
  };
  Branch exact[2], found[2];
  for (const int way : {0, 1}) {
    exact[way] = follow(way == 0 ? up : down, exactly);
    found[way] = follow(way == 0 ? up : down, by_integrator);
    double worst = 0;
    int same = 0;
    for (std::size_t i = 0; i < up.size(); ++i) {
      worst = std::max({worst, std::abs(exact[way].least[i] - found[way].least[i]),
                        std::abs(exact[way].greatest[i] - found[way].greatest[i])});
      if (class_of(exact[way].least[i], exact[way].greatest[i]) ==
          class_of(found[way].least[i], found[way].greatest[i]))
        ++same;
    }
    const std::string name = way == 0 ? "oscillator.up." : "oscillator.down.";
    numbers.push_back({name + "extremes", worst});
    numbers.push_back({name + "same_class", static_cast<double>(same)});
  }
  int apart = 0, apart_found = 0;
  constexpr double kOtherBranch = 1e-3;
  for (std::size_t i = 0; i < up.size(); ++i) {
    const std::size_t j = up.size() - 1 - i;
    if (std::abs(exact[0].greatest[i] - exact[1].greatest[j]) > kOtherBranch) ++apart;
    if (std::abs(found[0].greatest[i] - found[1].greatest[j]) > kOtherBranch) ++apart_found;
  }
  // Without a second branch the sweep would show nothing.
  numbers.push_back(
      {"oscillator.second_branch_missed", apart > 0 ? std::abs(apart_found - apart) : HUGE_VAL});
}

void compare_steady(const Integrated& integrated, Numbers& numbers) {
  for (const double frequency : {0.5, 0.8, 1.2}) {
    Equation of;
    of.frequency = frequency;
    Exact settling(of, {});
    Seen seen;
    settling.advance(of.period() * 60, seen);
    const Periodic exact = exact_periodic(of, settling.state());
    const coupled::SteadyMotion found = integrated.steady(of, settling.state());
    const double worst = std::max(std::abs(found.motion[kLag] - exact.state.x),
                                  std::abs(found.motion[kLagRate] - exact.state.v));
    const std::string where = at_text(frequency);
    numbers.push_back({where + "periodic", worst});
    numbers.push_back({where + "multiplier",
                       found.multipliers.empty()
                           ? HUGE_VAL
                           : std::abs(found.multipliers.front()) / exact.largest_multiplier - 1});
  }
}

}  // namespace

Numbers oscillator() {
  const Integrated integrated;
  Numbers numbers;
  compare_waveform(integrated, numbers);
  compare_branches(integrated, numbers);
  compare_steady(integrated, numbers);
  return numbers;
}

}  // namespace bentaxis::external

#include "hybrid_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::coupled {
namespace {

constexpr long kMaxSteps = 20000000;  // some minutes of the closed form
// What a simulation would take is foreseen after so many steps; it is given up early where that is
// so many times too much.
constexpr long kStepsToForesee = 200000;
constexpr double kHopeless = 3;
constexpr std::size_t kMaxEvents = 1000000;
// A step that is expected to reach an edge goes beyond it by this part of itself.
constexpr double kBeyond = 1e-6;
constexpr double kOnTouch = 1e-15;  // m: as good as touching
constexpr int kMaxShortSteps = 1000;
constexpr int kHalvings = 60;  // of a step, to a touch within it
constexpr double kRounding = std::numeric_limits<double>::epsilon();

using Reached = numerics::StiffIntegrator::Reached;
using Reason = numerics::IntegrationFailure::Reason;

constexpr const char* kStates = "motion or pressures";

}  // namespace

HybridIntegrator::HybridIntegrator(std::string name, Mechanics& mechanics, const Oil& oil,
                                   double tolerance, bool balances)
    : name_(std::move(name)),
      system_(mechanics, oil, balances),
      integrator_(system_, tolerance),
      edges_(oil.edges_deg()),
      breakpoints_(breakpoints_of(mechanics, oil)),
      has_oil_(oil.states() > 0) {
  integrals_.assign(static_cast<std::size_t>(system_.integrals()), 0.0);
}

void HybridIntegrator::fail(const std::string& why) const {
  const double speed = shaft(time_, state_).speed / kRadPerSecondPerRpm;
  throw ComputationError(name_ + (has_oil_ ? " model with oil" : " model") +
                         ": the simulation stops at " + rounded_text(time_) + " s, the shaft at " +
                         rounded_text(speed) + " rpm: " + why);
}

void HybridIntegrator::start(double time, const SystemState& state) {
  time_ = step_start_ = time;
  state_ = state;
  std::fill(integrals_.begin(), integrals_.end(), 0.0);
  edges_.find(block(time_, state_));
  set_interval();
  start_contacts();
  system_.forget();
  restart_ = true;
}

void HybridIntegrator::go_back(double time) {
  if (time < time_) {
    SystemState there;
    state_at(time, there);
    read_integrals(time, integrals_);
    state_ = there;
    time_ = time;
    touching_ = before_.touching;
    events_.resize(before_.events);
    apart_ = before_.apart;
    if (system_.mechanics().compliant() && !touching()) apart_ += time - step_start_;
    edges_.find(block(time_, state_));
    set_interval();
  } else if (step_start_ != time_) {
    read_integrals(time_, integrals_);
  }
  step_start_ = time_;
  system_.forget();
  restart_ = true;
}

void HybridIntegrator::set_interval() {
  system_.from = edges_.from();
  system_.to = edges_.to();
}

bool HybridIntegrator::touching() const {
  return std::any_of(touching_.begin(), touching_.end(), [](const Touching& t) { return t.now; });
}

void HybridIntegrator::start_contacts() {
  touching_.assign(contacts().size(), {});
  Mechanics& mechanics = system_.mechanics();
  for (std::size_t i = 0; i < contacts().size(); ++i) {
    const double x = mechanics.approach(time_, state_.motion, contacts()[i]);
    double rate = mechanics.approach_rate(time_, state_.motion, contacts()[i]);
    if (x < -kOnTouch) continue;
    if (x <= kOnTouch && rate == 0) {
      // Without force between them: which way they begin to move.
      std::vector<double> dy(system_.scale().size());
      system_.scaled(state_, y_);
      if (!system_.rates(time_, y_.data(), dy.data())) continue;
      MotionVector moving{};
      for (std::size_t j = 0; j < system_.active().size(); ++j)
        if (system_.active()[j] == kLagRate) moving[kLagRate] = dy[j] * system_.scale()[j];
      rate = mechanics.approach_rate(time_, moving, contacts()[i]);
    }
    if (x <= kOnTouch && rate <= 0) continue;
    contact_changes(i, true);
  }
}

void HybridIntegrator::contact_changes(std::size_t contact, bool touch) {
  Touching& of = touching_[contact];
  if (touch == of.now) return;
  const Mechanics& mechanics = system_.mechanics();
  const bool wall = mechanics.carried_by_pistons();
  // Teeth of unequal pitch may press on both flanks; with one line of action each a flank that
  // touches has left the other.
  if (touch && !wall && touching_[1 - contact].now &&
      mechanics.approach(time_, state_.motion, contacts()[1 - contact]) <= kOnTouch)
    contact_changes(1 - contact, false);
  if (events_.size() >= kMaxEvents)
    fail("after " + std::to_string(kMaxEvents) + " touches of the " + (wall ? "pistons" : "teeth"));
  close_contact(of);
  of.now = touch;
  ToothEvent event;
  event.time_s = time_;
  event.touch = touch;
  event.flank = wall ? (state_.motion[kLag] < 0 ? -1 : 1) : contacts()[contact];
  if (wall) event.piston = contacts()[contact];
  event.shaft_speed = shaft(time_, state_).speed;
  event.block_speed = block(time_, state_).speed;
  event.approach_speed = mechanics.approach_rate(time_, state_.motion, contacts()[contact]);
  if (touch && !wall) {
    of.event = events_.size();
    of.impulse = state_.motion[kImpulse];
  }
  events_.push_back(event);
}

void HybridIntegrator::close_contact(Touching& of) {
  if (of.event < events_.size()) events_[of.event].impulse = state_.motion[kImpulse] - of.impulse;
  of.event = kNone;
}

void HybridIntegrator::close_contacts() {
  for (Touching& of : touching_) close_contact(of);
}

void HybridIntegrator::forget_events() {
  for (Touching& of : touching_) of.event = kNone;
  events_.clear();
  forgotten_steps_ = integrator_.steps();
}

void HybridIntegrator::state_at(double time, SystemState& state) const {
  if (time == time_ || step_start_ == time_) {
    state = state_;
    return;
  }
  state = state_;
  system_.unscaled(integrator_.state_at(time), state);
}

void HybridIntegrator::read_integrals(double time, std::vector<double>& integrals) const {
  if (integrals.empty()) return;
  const double* from = integrator_.integrals_at(time);
  std::copy_n(from, integrals.size(), integrals.begin());
}

void HybridIntegrator::integrals_at(double time, std::vector<double>& integrals) const {
  integrals = integrals_;
  if (step_start_ != time_) read_integrals(time, integrals);
  for (std::size_t i = 0; i < integrals.size(); ++i)
    integrals[i] *= system_.integral_scale(static_cast<int>(i));
}

double HybridIntegrator::time_at(double block_angle) const {
  double low = step_start_, high = time_;
  state_at(low, sampled_);
  const double sign = block(high, state_).angle >= block(low, sampled_).angle ? 1 : -1;
  double at = high;
  SystemState there;
  for (int i = 0; i < 100; ++i) {
    state_at(at, there);
    const AxisMotion b = block(at, there);
    const double left = block_angle - b.angle;
    if (left == 0 || high - low <= kRounding * high) break;
    (sign * left < 0 ? high : low) = at;
    const double next = at + left / b.speed;
    if (std::abs(next - at) <= kRounding * at) break;
    at = next > low && next < high ? next : (low + high) / 2;
  }
  return at;
}

// A contact that touched and left within the step: it is then taken back to the touch, until which
// nothing acted between them.
bool HybridIntegrator::hidden_touch() {
  if (touching()) return false;
  for (std::size_t i = 0; i < contacts().size(); ++i)
    if (hides_touch(i)) return true;
  return false;
}

bool HybridIntegrator::hides_touch(std::size_t contact) {
  const Mechanics& mechanics = system_.mechanics();
  const int number = contacts()[contact];
  SystemState at;
  const double first = step_start_;
  state_at(first, at);
  if (mechanics.approach(first, at.motion, number) >= 0 ||
      mechanics.approach_rate(first, at.motion, number) <= 0 ||
      mechanics.approach(time_, state_.motion, number) >= 0 ||
      mechanics.approach_rate(time_, state_.motion, number) >= 0)
    return false;
  double nearest = first;
  numerics::bisect({first, time_}, kHalvings, [&](double t) {
    nearest = t;
    state_at(t, at);
    return !(mechanics.approach_rate(t, at.motion, number) > 0);
  });
  if (mechanics.approach(nearest, at.motion, number) <= 0) return false;
  const auto is_in_contact = [&](double t) {
    state_at(t, at);
    return mechanics.approach(t, at.motion, number) > 0;
  };
  const double touch = numerics::bisect({first, nearest}, kHalvings, is_in_contact).high;
  state_at(touch, at);
  read_integrals(touch, integrals_);
  state_ = at;
  time_ = touch;
  contact_changes(contact, true);
  return true;
}

// Where the step should end: a step over an edge would be refused, so it is cut where the edge is
// expected.
double HybridIntegrator::horizon(double end) const {
  double stop = end;
  const auto breakpoint = std::upper_bound(breakpoints_.begin(), breakpoints_.end(), time_);
  if (breakpoint != breakpoints_.end()) stop = std::min(stop, *breakpoint);
  if (edges_.none()) return stop;
  const AxisMotion b = block(time_, state_);
  const double left = b.speed > 0 ? system_.to - b.angle : system_.from - b.angle;
  if (b.speed == 0 || left / b.speed <= 0) return stop;
  const double ahead = left / b.speed * (1 + kBeyond);
  const double least = 1e3 * kRounding * (time_ + std::abs(end));
  return std::min(stop, time_ + std::max(ahead, least));
}

void HybridIntegrator::keep_going() {
  if (integrator_.steps() > kStepsToForesee && time_ > 0) {
    const double expected = static_cast<double>(integrator_.steps()) * duration_ / time_;
    if (expected > kHopeless * static_cast<double>(kMaxSteps))
      fail("at this step size it would take " + rounded_text(expected) + " steps, more than " +
           std::to_string(kMaxSteps) + ": shorten the simulated time (duration_s)");
  }
  if (integrator_.steps() - forgotten_steps_ > kMaxSteps)
    fail("after " + std::to_string(kMaxSteps) +
         " steps: motion or pressures are too fast for the simulated time; shorten it (duration_s) "
         "or allow a larger error");
  if (time_ - step_start_ > 1e2 * kRounding * time_) {
    short_steps_ = 0;
    integrator_.forget_complaint();
  } else if (++short_steps_ > kMaxShortSteps) {
    const std::string complaint = integrator_.complaint();
    fail(complaint.empty() ? text_of(Reason::step, kStates) : complaint);
  }
}

void HybridIntegrator::advance(double end) {
  if (restart_) {
    system_.scaled(state_, y_);
    integrator_.start(time_, y_, integrals_);
    restart_ = false;
  }
  keep_going();
  passed_edge_.reset();
  at_breakpoint_ = false;
  before_.touching = touching_;
  before_.events = events_.size();
  before_.apart = apart_;
  const double stop = horizon(end);
  const double before = time_;
  Reached reached{};
  try {
    reached = integrator_.step(stop);
  } catch (const numerics::IntegrationFailure& failure) {
    fail(text_of(failure.reason(), kStates));
  } catch (const ComputationError& error) {
    fail(error.what());
  }
  step_start_ = before;
  time_ = integrator_.time();
  system_.unscaled(integrator_.state_at(time_), state_);

  if (!touching() && system_.mechanics().compliant()) {
    restart_ = hidden_touch();
    apart_ += time_ - before;
    if (restart_) {
      system_.forget();
      return;
    }
  }
  at_breakpoint_ = std::binary_search(breakpoints_.begin(), breakpoints_.end(), time_);
  if (at_breakpoint_) restart_ = true;
  if (!edges_.none()) {
    const double angle = block(time_, state_).angle;
    const std::vector<int>& passed = integrator_.passed();
    int side = 0;
    if (reached == Reached::event)
      side = passed[System::kTo] != 0 ? 1 : passed[System::kFrom] != 0 ? -1 : 0;
    if (side != 0) {
      passed_edge_ = side > 0 ? edges_.to() : edges_.from();
      edges_.pass(side);
      restart_ = true;
    } else if (edges_.left_by(angle)) {
      passed_edge_ = angle > edges_.to() ? edges_.to() : edges_.from();
      edges_.find(block(time_, state_));
      restart_ = true;
    }
    set_interval();
  }
  if (reached == Reached::event && system_.mechanics().compliant()) {
    const std::vector<int>& passed = integrator_.passed();
    for (const bool touch : {false, true})
      for (std::size_t i = 0; i < contacts().size(); ++i) {
        const int way = passed[System::kContacts + i];
        if (way == 0 || touch != (way > 0)) continue;
        contact_changes(i, touch);
        system_.forget();
        restart_ = true;
      }
  }
  // Until then they are the integrator's.
  if (restart_ || time_ == step_start_) read_integrals(time_, integrals_);
}

}  // namespace bentaxis::coupled

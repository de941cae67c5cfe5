#include "integration/event_stepper.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "integration/integrators.h"
#include "reactions/solver_guard.h"

namespace bentaxis::multibody {

using SimTK::Stage;
using SimTK::State;

namespace {

// Of the time reached: two times closer than that are one.
constexpr double kSameTime = 4e-16;
// Trials after which a landing is taken as it is.
constexpr int kMaxTrials = 60;
// That find the root of a cubic on 0..1 to round-off.
constexpr int kHalvings = 54;
// Steps after which what is left is foreseen: this share of those allowed, and not fewer than that.
constexpr long kForeseenShare = 50;
constexpr long kForeseenAfter = 1000;
// First step of all, s; the integrator finds its own from there.
constexpr double kFirstStep = 1e-6;

constexpr const char* kSmallSteps =
    "; causes of such small steps: very stiff teeth or coupling, very light bodies, high speed, an "
    "accuracy near round-off";

// A witness at a time; NaN for a rate that is not known.
struct Look {
  double time, value, rate;
};

// Where the cubic through both ends, or the line, is 0; it is below at the first and above at the
// second.
double root_between(const Look& low, const Look& high) {
  const double h = high.time - low.time;
  const auto cubic = [&](double s) {
    const double r = 1 - s;
    if (!std::isfinite(low.rate + high.rate)) return r * low.value + s * high.value;
    return r * r * ((1 + 2 * s) * low.value + s * h * low.rate) +
           s * s * ((1 + 2 * r) * high.value - r * h * high.rate);
  };
  const auto is_above = [&](double s) { return cubic(s) > 0; };
  return low.time + numerics::bisect({0, 1}, kHalvings, is_above).middle() * h;
}

}  // namespace

EventStepper::EventStepper(const SimTK::MultibodySystem& system, const IntegrationOptions& options,
                           long most_steps)
    : system_(system),
      integrator_(make_integrator(system, options)),
      most_steps_(most_steps),
      usual_step_(kFirstStep) {
  integrator_->setReturnEveryInternalStep(true);
}

void EventStepper::start(const State& state) {
  scratch_ = state;
  go_back({state.getTime(), state.getY()}, kFirstStep);
}

void EventStepper::restart() { go_back(here(), usual_step_); }

void EventStepper::go_back(const Point& point, double step) {
  scratch_.setTime(point.time);
  scratch_.updY() = point.variables;
  integrator_->setInitialStepSize(step);
  integrator_->initialize(scratch_);
}

// Whether time went on.
bool EventStepper::step_once(double time) {
  const double before = integrator_->getTime();
  alive();
  integrator_->stepTo(time);
  if (!(integrator_->getTime() > before)) return false;
  ++steps_;
  system_.realize(integrator_->getState(), Stage::Velocity);
  if (steps_ >= most_steps_)
    throw ComputationError(std::to_string(steps_) + " steps are used, the last of " +
                           short_text(integrator_->getTime() - before) + " s" + kSmallSteps);
  if (duration_ > 0 && steps_ % std::max(most_steps_ / kForeseenShare, kForeseenAfter) == 0 &&
      static_cast<double>(steps_) * duration_ >
          static_cast<double>(most_steps_) * integrator_->getTime())
    throw ComputationError("at steps of " + short_text(integrator_->getTime() - before) +
                           " s the " + number_text(duration_) + " s would take more than " +
                           std::to_string(most_steps_) + " of them" + kSmallSteps);
  return true;
}

void EventStepper::step_to(double time) {
  while (integrator_->getTime() < time) step_once(time);
}

int EventStepper::first_risen(const std::vector<Witness>& witnesses) const {
  for (std::size_t i = 0; i < witnesses.size(); ++i)
    if (witnesses[i].value(state()) > witnesses[i].tolerance) return static_cast<int>(i);
  return -1;
}

int EventStepper::advance(double time, const std::vector<Witness>& witnesses) {
  std::vector<double> values(witnesses.size());
  std::vector<double> rates(witnesses.size());
  while (integrator_->getTime() < time) {
    const Point from = here();
    system_.realize(state(), Stage::Velocity);
    for (std::size_t i = 0; i < witnesses.size(); ++i) {
      values[i] = witnesses[i].value(state());
      rates[i] = witnesses[i].rate ? witnesses[i].rate(state()) : 0;
    }
    if (!step_once(time)) continue;
    if (time > integrator_->getTime()) usual_step_ = integrator_->getTime() - from.time;
    int risen = first_risen(witnesses);
    for (std::size_t i = 0; risen < 0 && i < witnesses.size(); ++i)
      if (witnesses[i].rate && turned_back_beyond(witnesses[i], from, values[i], rates[i]))
        risen = first_risen(witnesses);
    if (risen >= 0) return land(risen, from, witnesses);
  }
  return -1;
}

// A value that rises and falls again within a step may have been beyond 0 in between: the cubic
// through both ends says where it was greatest. If it was, the step is done again to there.
bool EventStepper::turned_back_beyond(const Witness& witness, const Point& from, double value,
                                      double rate) {
  const double end_rate = witness.rate(state());
  if (!(rate > 0 && end_rate < 0)) return false;
  const double h = time() - from.time;
  const double end = witness.value(state());
  // Derivative over s = 0..1: a s^2 + b s + c.
  const double c = rate * h;
  const double a = 3 * (c + end_rate * h) - 6 * (end - value);
  const double b = end_rate * h - a - c;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double s = std::clamp(2 * c / (root - b), 0.0, 1.0);  // where it falls through 0
  const double greatest = value + s * (c + s * (b / 2 + s * a / 3));
  if (!(greatest > witness.tolerance) || !(s > 0 && s < 1)) return false;
  go_back(from, s * h);
  step_to(from.time + s * h);
  return true;
}

int EventStepper::land(int risen, Point from, const std::vector<Witness>& witnesses) {
  const auto look = [&] {
    const Witness& witness = witnesses[static_cast<std::size_t>(risen)];
    return Look{time(), witness.value(state()), witness.rate ? witness.rate(state()) : SimTK::NaN};
  };
  Look high = look();
  go_back(from, high.time - from.time);
  system_.realize(state(), Stage::Velocity);
  Look low = look();
  for (int trial = 0; trial < kMaxTrials; ++trial) {
    if (high.time - low.time <= kSameTime * high.time) break;
    // A guess that keeps falling to one side is helped by halving.
    double target = trial % 4 == 3 ? (low.time + high.time) / 2 : root_between(low, high);
    if (!(target > low.time && target < high.time)) target = (low.time + high.time) / 2;
    if (!(target > low.time && target < high.time)) break;
    step_to(target);
    const int now = first_risen(witnesses);
    if (now >= 0 && now != risen) {  // another witness, before this one
      risen = now;
      high = look();
      go_back(from, high.time - from.time);
      system_.realize(state(), Stage::Velocity);
      low = look();
      continue;
    }
    const Look here_now = look();
    if (std::abs(here_now.value) <= witnesses[static_cast<std::size_t>(risen)].tolerance)
      return risen;
    if (now < 0) {
      from = here();
      low = here_now;
    } else {
      high = here_now;
      go_back(from, high.time - from.time);
    }
  }
  // Nothing lies between the last state before and the first after.
  step_to(high.time);
  return risen;
}

}  // namespace bentaxis::multibody

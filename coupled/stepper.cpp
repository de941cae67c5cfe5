#include "bentaxis/coupled/stepper.h"

#include <algorithm>
#include <utility>

#include "bentaxis/pump/error.h"
#include "hybrid_integrator.h"

namespace bentaxis::coupled {

class Stepper::Implementation {
 public:
  Implementation(std::string name, Mechanics& mechanics, Oil& oil, double tolerance)
      : mechanics_(mechanics),
        oil_(oil),
        integrator_(std::move(name), mechanics, oil, tolerance, true) {}

  void start(double time, const SystemState& state, double end) {
    time_ = time;
    end_ = end;
    span_ = end - time;
    state_ = state;
    restart();
  }

  void restart() {
    // The integrator was ahead: what it has met beyond the present time may not happen.
    const auto is_ahead = [this](const PassedEvent& event) { return event.time > time_; };
    events_.erase(std::remove_if(events_.begin(), events_.end(), is_ahead), events_.end());
    integrator_.start(time_, state_);
    integrator_.forget_events();
  }

  void set_inputs(const Surroundings& outside) {
    if (outside == outside_) return;
    mechanics_.set_inputs(outside);
    oil_.set_inputs(outside);
    outside_ = outside;
    restart();
  }

  void step_to(double time) {
    begin_step(time);
    advance_or_restart(time, [&](double end) {
      while (integrator_.time() < time) advance(end);
    });
    stand_at(time);
  }

  void step_towards(double time) {
    begin_step(time);
    advance_or_restart(time, [&](double end) {
      if (integrator_.time() <= time_) advance(end);
    });
    stand_at(std::min(integrator_.time(), time));
  }

  std::vector<PassedEvent> passed() const {
    std::vector<PassedEvent> all;
    for (const PassedEvent& event : events_)
      if (event.time <= time_) all.push_back(event);
    return all;
  }

  double time() const { return time_; }
  const SystemState& state() const { return state_; }
  const Surroundings& surroundings() const { return outside_; }
  long steps() const { return integrator_.steps(); }

 private:
  void begin_step(double time) {
    const auto is_told = [this](const PassedEvent& event) { return event.time <= time_; };
    events_.erase(std::remove_if(events_.begin(), events_.end(), is_told), events_.end());
    // Beyond the end another one is expected as far away, so that steps go on over points there
    // too.
    if (time > end_) end_ = std::max(time, end_ + span_);
  }

  template <class Advance>
  void advance_or_restart(double time, Advance advance_until) {
    try {
      advance_until(end_);
    } catch (const ComputationError&) {
      // What lies beyond the point need not be possible: it may be changed there.
      restart();
      try {
        advance_until(time);
      } catch (...) {
        restart();
        throw;
      }
    }
  }

  void advance(double end) {
    integrator_.advance(end);
    note_events();
    integrator_.forget_events();
  }

  void stand_at(double time) {
    integrator_.state_at(time, state_);
    time_ = time;
  }

  void note_events() {
    using Kind = PassedEvent::Kind;
    if (integrator_.at_breakpoint()) events_.push_back({Kind::breakpoint, integrator_.time()});
    if (const auto angle = integrator_.passed_edge())
      events_.push_back({Kind::edge, integrator_.time(), *angle});
    for (const ToothEvent& event : integrator_.events())
      events_.push_back(
          {event.touch ? Kind::touch : Kind::release, event.time_s, 0, event.flank, event.piston});
  }

  Mechanics& mechanics_;
  Oil& oil_;
  HybridIntegrator integrator_;
  std::vector<PassedEvent> events_;  // since the last step_to(), and beyond time_
  Surroundings outside_;
  double time_ = 0, end_ = 0, span_ = 0;
  SystemState state_;
};

Stepper::Stepper(std::string name, Mechanics& mechanics, Oil& oil, double tolerance)
    : it_(std::make_unique<Implementation>(std::move(name), mechanics, oil, tolerance)) {}
Stepper::~Stepper() = default;
void Stepper::start(double time, const SystemState& state, double end) {
  it_->start(time, state, end);
}
void Stepper::restart() { it_->restart(); }
void Stepper::set_inputs(const Surroundings& outside) { it_->set_inputs(outside); }
const Surroundings& Stepper::surroundings() const { return it_->surroundings(); }
void Stepper::step_to(double time) { it_->step_to(time); }
void Stepper::step_towards(double time) { it_->step_towards(time); }
double Stepper::time() const { return it_->time(); }
const SystemState& Stepper::state() const { return it_->state(); }
std::vector<PassedEvent> Stepper::passed() const { return it_->passed(); }
long Stepper::steps() const { return it_->steps(); }

}  // namespace bentaxis::coupled

#include "bentaxis/coupled/tooth_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "hybrid_integrator.h"

namespace bentaxis::coupled {

ContactInterval operator+(const ContactInterval& a, const ContactInterval& b) {
  return {a.duration + b.duration,
          a.apart + b.apart,
          a.plus + b.plus,
          a.minus + b.minus,
          std::max(a.largest, b.largest),
          a.impulse + b.impulse,
          a.separations + b.separations,
          a.impacts + b.impacts,
          std::max(a.largest_hit, b.largest_hit)};
}

class ToothWatch::Watcher {
 public:
  Watcher(std::string name, Mechanics& mechanics, const Oil& oil, double tolerance,
          double impact_speed)
      : mechanics_(mechanics),
        oil_(oil),
        impact_speed_(impact_speed),
        integrator_(std::move(name), mechanics, oil, tolerance, true) {}

  void start(const MotionVector& motion) {
    state_ = {motion, oil_.start()};
    state_.motion[kImpulse] = 0;
    integrator_.start(0, state_);
    // What touches now began before.
    touching_.assign(mechanics_.contacts().size(), {});
    for (const ToothEvent& event : integrator_.events()) {
      of(event).now = event.touch;
      of(event).side = event.flank;
    }
    seen_ = integrator_.events().size();
    known_ = 0;
  }

  ContactInterval run_to(double time) {
    ContactInterval s;
    const double from = integrator_.time();
    const double apart = integrator_.time_apart();
    const double impulse = state_.motion[kImpulse];
    since_ = from;
    note_force(s);
    while (integrator_.time() < time) {
      integrator_.advance(time);
      integrator_.state_at(integrator_.time(), state_);
      note_events(s);
      note_force(s);
    }
    on_side(s, integrator_.time());
    s.duration = integrator_.time() - from;
    s.apart = integrator_.time_apart() - apart;
    s.impulse = state_.motion[kImpulse] - impulse;
    return s;
  }

  const MotionVector& motion() const { return state_.motion; }
  long steps() const { return integrator_.steps(); }

 private:
  struct Touching {
    bool now = false;
    int side = 1;
    bool hit = false;       // by an impact
    std::size_t event = 0;  // of its touch
  };
  // Flanks +1 and -1, or pistons in their order.
  Touching& of(const ToothEvent& event) {
    return touching_[event.piston > 0 ? static_cast<std::size_t>(event.piston) - 1
                                      : (event.flank > 0 ? 0 : 1)];
  }
  bool touches(int side) const {
    return std::any_of(touching_.begin(), touching_.end(),
                       [side](const Touching& t) { return t.now && t.side == side; });
  }

  void on_side(ContactInterval& s, double until) {
    if (touches(1)) s.plus += until - since_;
    if (touches(-1)) s.minus += until - since_;
    since_ = until;
  }

  void note_events(ContactInterval& s) {
    for (; seen_ < integrator_.events().size(); ++seen_) {
      const ToothEvent& event = integrator_.events()[seen_];
      on_side(s, event.time_s);
      known_ = 0;
      Touching& contact = of(event);
      if (event.touch) {
        contact = {true, event.flank, event.approach_speed >= impact_speed_, seen_};
        s.impacts += contact.hit ? 1 : 0;
      } else {
        ++s.separations;
        if (contact.hit)
          s.largest_hit = std::max(s.largest_hit, integrator_.events()[contact.event].impulse);
        contact = {};
      }
    }
  }

  void note_force(ContactInterval& s) {
    if (!touches(1) && !touches(-1)) return;
    const double time = integrator_.time();
    oil_.loads(time, mechanics_.block(time, state_.motion), state_.oil.data(), loads_);
    MotionVector rates{};
    mechanics_.rates(time, state_.motion, loads_, rates);
    s.largest = std::max(s.largest, rates[kImpulse]);
    if (known_ > 0 && time == times_[2]) return;
    std::rotate(times_.begin(), times_.begin() + 1, times_.end());
    std::rotate(forces_.begin(), forces_.begin() + 1, forces_.end());
    times_[2] = time;
    forces_[2] = rates[kImpulse];
    ++known_;
    if (known_ >= 3 && forces_[1] > forces_[0] && forces_[1] >= forces_[2])
      s.largest = std::max(s.largest, top());
  }

  // Of the parabola through the last three forces, the middle one of which is the largest.
  double top() const {
    const double h0 = times_[1] - times_[0], h1 = times_[2] - times_[1];
    const double d0 = (forces_[1] - forces_[0]) / h0, d1 = (forces_[2] - forces_[1]) / h1;
    const double curvature = (d1 - d0) / (h0 + h1);  // half of it
    const double slope = (d0 * h1 + d1 * h0) / (h0 + h1);
    return forces_[1] - slope * slope / (4 * curvature);
  }

  Mechanics& mechanics_;
  const Oil& oil_;
  double impact_speed_;
  HybridIntegrator integrator_;
  SystemState state_;
  OilLoads loads_;
  std::size_t seen_ = 0;            // events
  std::vector<Touching> touching_;  // by contact
  double since_ = 0;
  std::array<double, 3> times_{}, forces_{};  // of the contact's last steps
  int known_ = 0;
};

ToothWatch::ToothWatch(std::string name, Mechanics& mechanics, const Oil& oil, double tolerance,
                       double impact_speed)
    : watcher_(
          std::make_unique<Watcher>(std::move(name), mechanics, oil, tolerance, impact_speed)) {}
ToothWatch::~ToothWatch() = default;
void ToothWatch::start(const MotionVector& motion) { watcher_->start(motion); }
ContactInterval ToothWatch::run_to(double time) { return watcher_->run_to(time); }
const MotionVector& ToothWatch::motion() const { return watcher_->motion(); }
long ToothWatch::steps() const { return watcher_->steps(); }

}  // namespace bentaxis::coupled

#include "simulation/events.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic::simulation {
namespace {

using closed_form::WallMode;

constexpr double kOnTouch = 1e-15;           // m: as good as touching
constexpr double kOnEdge = 1e-15;            // of the angle and a turn
constexpr double kOnWall = 2e-17;            // m: a stiff wall gives 2 nN there
constexpr double kOnPush = 1e-12;            // share of a force
constexpr std::size_t kMaxEvents = 1000000;  // of contact

}  // namespace

void stop_simulation(double time, const std::string& why) {
  throw ComputationError("analytic model: the simulation stops at " + number_text(time) +
                         " s: " + why);
}

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

// ---- Edges of the pressure

void PressureInterval::start(double time, const State& y) {
  if (edges_deg_.empty()) {
    equations_.from_angle = -1e300;
    equations_.to_angle = 1e300;
    return;
  }
  const double angle = equations_.block_angle(time, y) / kRadPerDegree;
  turn_ = std::floor(angle / 360);
  const double within = angle - 360 * turn_;
  edge_ = std::upper_bound(edges_deg_.begin(), edges_deg_.end(), within) - edges_deg_.begin();
  set();
  // On an edge, but for the rounding of both: the interval is that which the block enters.
  const double psi = equations_.block_angle(time, y);
  const bool above = psi - equations_.from_angle <= Equations::kAtEdge;
  const bool below = equations_.to_angle - psi <= Equations::kAtEdge;
  if (!above && !below) return;
  State dy;
  equations_.rates(time, y, dy);
  const Motion m = equations_.motion(time, y);
  const bool back = m.block.speed < 0 || (m.block.speed == 0 && m.block.acceleration < 0);
  if (back == above) pass(!back);
}

void PressureInterval::pass(bool upper_end) {
  edge_ += upper_end ? 1 : -1;
  set();
}

double PressureInterval::edge_deg(std::ptrdiff_t index) const {
  const auto count = static_cast<std::ptrdiff_t>(edges_deg_.size());
  const std::ptrdiff_t turns = index / count - (index % count < 0 ? 1 : 0);
  return edges_deg_[static_cast<std::size_t>(index - turns * count)] +
         360 * (turn_ + static_cast<double>(turns));
}

void PressureInterval::set() {
  equations_.from_angle = radians(edge_deg(edge_ - 1));
  equations_.to_angle = radians(edge_deg(edge_));
}

void PressureInterval::add_functions(double time, const State& y, EventFunctions& g) const {
  const double psi = equations_.block_angle(time, y);
  const double psi_rate = equations_.block_speed(time, y);
  g.add(psi - equations_.to_angle, psi_rate);
  g.add(equations_.from_angle - psi, -psi_rate);
}

double PressureInterval::nearness(double time, const State& y) const {
  return kOnEdge * (std::abs(equations_.block_angle(time, y)) + 2 * kPi);
}

// ---- Contacts

void Contacts::start(double time, State& y) {
  start_teeth(time, y);
  if (equations_.walls()) start_walls(time, y);
  if (equations_.teeth.pressing != 0) flank_changes(0, equations_.teeth.pressing, time, y);
}

void Contacts::start_teeth(double time, const State& y) {
  Teeth& teeth = equations_.teeth;
  teeth = {};
  if (!equations_.compliant() || equations_.walls()) return;
  State dy;
  for (const int flank : {1, -1}) {
    const double x = equations_.approach(y, flank);
    double rate = equations_.approach_rate(y, flank);
    if (x < -kOnTouch) continue;
    if (x <= kOnTouch && rate == 0) {
      equations_.rates(time, y, dy);  // without force
      rate = flank * dy[kLagRate];
    }
    if (x <= kOnTouch && rate <= 0) continue;
    if (1 + equations_.law().dissipation * equations_.approach_rate(y, flank) > 0)
      teeth.pressing = flank;
    else
      teeth.idle = flank;
    return;
  }
}

void Contacts::start_walls(double time, const State& y) {
  auto& modes = equations_.wall_modes;
  std::fill(modes.begin(), modes.end(), WallMode::away);
  State dy;
  equations_.rates(time, y, dy);
  const std::vector<WallPath>& paths = equations_.wall_paths(time, y);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const WallPath& path = paths[k];
    if (path.distance > kOnTouch || (path.distance >= -kOnTouch && path.rate > 0))
      if (1 + equations_.walls()->dissipation() * path.rate > 0) {
        modes[k] = WallMode::pressing;
        wall_changes(k, true, path.rate, time, y);
      }
  }
  inside_.assign(modes.size(), false);
  for (std::size_t k = 0; k < modes.size(); ++k)
    inside_[k] = modes[k] == WallMode::pressing || paths[k].distance > kOnTouch;
}

void Contacts::add_functions(double time, const State& y, const State& dy,
                             EventFunctions& g) const {
  const Equations& e = equations_;
  if (!e.compliant()) return;
  if (e.walls()) {
    // Of each piston two: touching or leaving its wall, and the end or start of its push within.
    const double dissipation = e.walls()->dissipation();
    const std::vector<WallPath>& paths = e.wall_paths(time, y);
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const WallPath& path = paths[k];
      if (!inside_[k]) {
        g.add(path.distance, path.rate);
        g.add(-1, 0);
        continue;
      }
      g.add(-path.distance, -path.rate);
      const int sign = e.wall_modes[k] == WallMode::pressing ? -1 : 1;
      g.add(sign * (1 + dissipation * path.rate), sign * dissipation * path.rate_dot);
    }
    return;
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
}

double Contacts::nearness(std::size_t function) const {
  // A wall's approach is a difference of lengths of some centimetres.
  if (equations_.walls()) return function % 2 == 1 ? kOnPush : kOnWall;
  return function == 1 && equations_.teeth.pressing + equations_.teeth.idle != 0 ? kOnPush
                                                                                 : kOnTouch;
}

bool Contacts::change(std::size_t function, double time, State& y) {
  if (equations_.walls()) {
    change_wall(function / 2, function % 2 == 0, time, y);
    return false;
  }
  const bool was_apart = is_apart();
  change_flank(function == 0, time, y);
  return is_apart() != was_apart;
}

void Contacts::change_flank(bool first_function, double time, State& y) {
  const Teeth was = equations_.teeth;
  const int within = was.pressing + was.idle;
  Teeth& teeth = equations_.teeth;
  if (within == 0) {
    const int flank = first_function ? 1 : -1;
    y[kLag] = flank * equations_.law().half_backlash / equations_.law().arm;
    const bool pushes = 1 + equations_.law().dissipation * equations_.approach_rate(y, flank) > 0;
    (pushes ? teeth.pressing : teeth.idle) = flank;
  } else if (first_function) {
    y[kLag] = within * equations_.law().half_backlash / equations_.law().arm;
    teeth = {};
  } else {
    std::swap(teeth.pressing, teeth.idle);
  }
  if (was.pressing != teeth.pressing) flank_changes(was.pressing, teeth.pressing, time, y);
}

// A piston passes the end of contact, or its push ends or starts within.
void Contacts::change_wall(std::size_t piston, bool passes, double time, const State& y) {
  const WallPath path = equations_.wall_paths(time, y)[piston];
  WallMode& mode = equations_.wall_modes[piston];
  const bool pressed = mode == WallMode::pressing;
  if (passes) inside_[piston] = !inside_[piston];
  const bool pushes = inside_[piston] &&
                      (passes ? 1 + equations_.walls()->dissipation() * path.rate > 0 : !pressed);
  mode = pushes ? WallMode::pressing : WallMode::away;
  if (pushes != pressed) wall_changes(piston, pushes, path.rate, time, y);
}

bool Contacts::is_apart() const {
  const auto& modes = equations_.wall_modes;
  return equations_.walls()
             ? std::find(modes.begin(), modes.end(), WallMode::pressing) == modes.end()
             : equations_.teeth.pressing == 0;
}

ToothEvent Contacts::event(double time, const State& y, bool touch) const {
  ToothEvent event;
  event.time_s = time;
  event.touch = touch;
  event.shaft_speed = equations_.speed(time, y);
  event.block_speed = equations_.block_speed(time, y);
  return event;
}

void Contacts::add(ToothEvent event, const char* bodies) {
  if (events_.size() >= kMaxEvents)
    stop_simulation(event.time_s,
                    "after " + std::to_string(kMaxEvents) + " touches of the " + bodies);
  events_.push_back(event);
}

void Contacts::wall_changes(std::size_t piston, bool touch, double approach_speed, double time,
                            const State& y) {
  ToothEvent wall = event(time, y, touch);
  wall.flank = y[kLag] < 0 ? -1 : 1;
  wall.piston = static_cast<int>(piston) + 1;
  wall.approach_speed = approach_speed;
  add(wall, "pistons");
}

void Contacts::flank_changes(int from, int to, double time, State& y) {
  if (from != 0) close(y);
  ToothEvent flank = event(time, y, to != 0);
  flank.flank = to != 0 ? to : from;
  flank.approach_speed = equations_.approach_rate(y, flank.flank);
  add(flank, "teeth");
  if (to == 0) return;
  touch_ = events_.size() - 1;
  y[kImpulse] = 0;
}

void Contacts::close(const State& y) {
  if (touch_ < events_.size()) events_[touch_].impulse = y[kImpulse];
  touch_ = kNone;
}

}  // namespace bentaxis::analytic::simulation

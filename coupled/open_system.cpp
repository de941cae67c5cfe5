#include "bentaxis/coupled/open_system.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/lists.h"
#include "port_edges.h"
#include "system.h"

namespace bentaxis::coupled {
namespace {

// An edge is passed where the block is beyond it by this, rad: what lies behind an event has then
// begun.
constexpr double kPastEdge = 1e-10;
constexpr double kAngle = 0.1;  // rad, over which pressures change

struct MotionName {
  MotionIndex index;
  const char *name, *unit, *meaning;
};
constexpr MotionName kMotionNames[] = {
    {kTurn, "shaft_angle", "rad", "angle of the shaft, theta"},
    {kTurnRate, "shaft_speed", "rad/s", "speed of the shaft, theta'"},
    {kLag, "lag", "rad", "theta - psi, by which the block lags behind the shaft"},
    {kLagRate, "lag_rate", "rad/s", "rate of the lag"},
    {kTwist, "twist", "rad", "of the coupling, phi - theta"},
    {kTwistRate, "twist_rate", "rad/s", "rate of the twist"},
};

}  // namespace

OpenSystem::OpenSystem(Mechanics& mechanics, Oil& oil, bool shaft_from_outside)
    : mechanics_(mechanics),
      oil_(oil),
      edges_(std::make_unique<PortEdges>(oil.edges_deg())),
      angle_is_state_(shaft_from_outside),
      start_speed_(mechanics.shaft(0, MotionVector{}).speed) {
  active_ = moving(mechanics);
  const MotionVector scales = mechanics.scales();
  if (angle_is_state_)
    states_.push_back(
        {kMotionNames[kTurn].name, kMotionNames[kTurn].unit, kMotionNames[kTurn].meaning, kAngle});
  for (const std::size_t index : active_) {
    const MotionName& is = kMotionNames[index];
    states_.push_back({is.name, is.unit, is.meaning, scales[index]});
  }
  const std::vector<double> of_oil = oil.scales();
  std::vector<OilColumn> names = oil.state_columns();
  names.resize(of_oil.size());
  for (std::size_t i = 0; i < of_oil.size(); ++i)
    states_.push_back({"oil." + names[i].name, "", names[i].meaning, of_oil[i]});
  if (!edges_->none()) {
    indicators_.push_back(
        {"edge_ahead", "rad", "angle of the block up to the next edge of a port"});
    indicators_.push_back(
        {"edge_behind", "rad", "angle of the block from the last edge of a port"});
  }
  contacts_ = mechanics.contacts();
  for (const int contact : contacts_)
    if (mechanics.carried_by_pistons())
      indicators_.push_back({"wall_" + std::to_string(contact), "m",
                             "approach of piston " + std::to_string(contact) + " to its wall"});
    else if (contact > 0)
      indicators_.push_back(
          {"flank_plus", "m", "approach of the flank that pushes the block forwards"});
    else
      indicators_.push_back(
          {"flank_minus", "m", "approach of the flank that pushes the block backwards"});
  breakpoints_ = breakpoints_of(mechanics, oil);
  loads_.chamber_pressure.assign(static_cast<std::size_t>(oil.pistons()), 0.0);
  oil_rates_.resize(of_oil.size());
}

OpenSystem::~OpenSystem() = default;

void OpenSystem::tell_mechanics() {
  if (!angle_is_state_) return;
  Surroundings now = outside_;
  now.time = time_;
  if (!now.shaft) now.shaft = mechanics_.shaft(time_, state_.motion);
  now.shaft->angle = angle_;
  mechanics_.set_inputs(now);
}

void OpenSystem::start(double time, const SystemState& state) {
  time_ = time;
  state_ = state;
  angle_ = mechanics_.shaft(time, state.motion).angle;
  tell_mechanics();
  pass_event();
}

void OpenSystem::set_inputs(const Surroundings& outside) {
  outside_ = outside;
  oil_.set_inputs(outside);
  if (angle_is_state_)
    tell_mechanics();
  else
    mechanics_.set_inputs(outside);
}

void OpenSystem::set_time(double time) {
  // Of a free shaft angle and speed are the states, not what they are relative to.
  if (mechanics_.shaft_is_free()) state_.motion[kTurn] -= start_speed_ * (time - time_);
  time_ = time;
  tell_mechanics();
}

void OpenSystem::set(const std::vector<double>& values) {
  std::size_t i = 0;
  if (angle_is_state_) angle_ = values[i++];
  for (const std::size_t index : active_) {
    double value = values[i++];
    if (index == kTurn) value -= start_speed_ * time_;
    if (index == kTurnRate) value -= start_speed_;
    state_.motion[index] = value;
  }
  for (double& value : state_.oil) value = values[i++];
  tell_mechanics();
}

std::vector<double> OpenSystem::values() const {
  std::vector<double> values;
  values.reserve(states_.size());
  if (angle_is_state_) values.push_back(angle_);
  for (const std::size_t index : active_) {
    double value = state_.motion[index];
    if (index == kTurn) value += start_speed_ * time_;
    if (index == kTurnRate) value += start_speed_;
    values.push_back(value);
  }
  append(values, state_.oil);
  return values;
}

bool OpenSystem::rates(std::vector<double>& rates) {
  rates.clear();
  const AxisMotion shaft = mechanics_.shaft(time_, state_.motion);
  const AxisMotion block = this->block();
  if (angle_is_state_) rates.push_back(shaft.speed);
  if (!active_.empty()) {
    MotionVector dy{};
    oil_.loads(time_, block, state_.oil.data(), loads_);
    mechanics_.rates(time_, state_.motion, loads_, dy);
    for (const std::size_t index : active_)
      rates.push_back(index == kTurn ? start_speed_ + dy[index] : dy[index]);
  }
  if (!oil_rates_.empty() && !oil_.rates(time_, shaft, block, state_.oil.data(), oil_rates_.data()))
    return false;
  append(rates, oil_rates_);
  return std::all_of(rates.begin(), rates.end(), [](double v) { return std::isfinite(v); });
}

void OpenSystem::indicator_values(std::vector<double>& values) const {
  values.clear();
  if (!edges_->none()) {
    const double angle = block().angle;
    values.push_back(edges_->to() + kPastEdge - angle);
    values.push_back(angle - (edges_->from() - kPastEdge));
  }
  for (const int contact : contacts_)
    values.push_back(mechanics_.approach(time_, state_.motion, contact));
}

void OpenSystem::pass_event() { edges_->find(block()); }

bool OpenSystem::beyond() const { return !edges_->none() && edges_->left_by(block().angle); }

std::optional<double> OpenSystem::next_breakpoint() const {
  const auto next = std::upper_bound(breakpoints_.begin(), breakpoints_.end(), time_);
  if (next == breakpoints_.end()) return std::nullopt;
  return *next;
}

}  // namespace bentaxis::coupled

#include "system.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::coupled {
namespace {

// Differences for Newton's method, of a state's scale and of the pressures.
constexpr double kDifference = 1e-6;
constexpr double kPressureDifference = 1e-4;
// Derivatives of the mechanics serve until the block has turned by this, rad, or a state of motion
// has moved by this part of its scale.
constexpr double kServesFor = kRadPerDegree;
constexpr double kServesForState = 0.2;
// What the oil's masses are measured by, of the mass of the circuit: that of a pressure, of peak.
constexpr double kCompressed = 1e-2;

double power_of_two(double size) { return std::exp2(std::round(std::log2(size))); }

bool all_finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double v) { return std::isfinite(v); });
}

}  // namespace

std::vector<std::size_t> moving(const Mechanics& mechanics) {
  std::vector<std::size_t> states;
  if (mechanics.shaft_is_free()) states.insert(states.end(), {kTurn, kTurnRate});
  if (mechanics.compliant()) states.insert(states.end(), {kLag, kLagRate});
  if (mechanics.has_motor()) states.insert(states.end(), {kTwist, kTwistRate});
  return states;
}

std::vector<double> breakpoints_of(const Mechanics& mechanics, const Oil& oil) {
  std::vector<double> breakpoints = mechanics.breakpoints();
  append(breakpoints, oil.breakpoints());
  std::sort(breakpoints.begin(), breakpoints.end());
  return breakpoints;
}

void pack(const SystemState& state, const std::vector<std::size_t>& motions,
          const std::vector<double>& scale, double* y) {
  std::size_t i = 0;
  const auto put = [&](double value) { y[i] = value / scale[i], ++i; };
  for (const std::size_t index : motions) put(state.motion[index]);
  for (const double value : state.oil) put(value);
}

void unpack(const double* y, const std::vector<std::size_t>& motions,
            const std::vector<double>& scale, SystemState& state) {
  std::size_t i = 0;
  const auto take = [&](double& value) { value = y[i] * scale[i], ++i; };
  for (const std::size_t index : motions) take(state.motion[index]);
  for (double& value : state.oil) take(value);
}

System::System(Mechanics& mechanics, const Oil& oil, bool balances)
    : mechanics_(mechanics),
      oil_(oil),
      balances_(balances),
      active_(moving(mechanics)),
      contacts_(mechanics.contacts()) {
  const MotionVector scales = mechanics.scales();
  motions_ = static_cast<int>(active_.size());
  if (balances) {
    active_.insert(active_.end(), {kWorkOfLoads, kWorkOfDrive});
    if (mechanics.compliant()) active_.push_back(kImpulse);
  }
  for (const std::size_t index : active_) scale_.push_back(power_of_two(scales[index]));
  const std::vector<double> oil_scales = oil.scales();
  for (const double scale : oil_scales) scale_.push_back(power_of_two(scale));
  places_ = static_cast<int>(oil.places().size());

  state_.motion = mechanics.start();
  state_.oil = oil.start();
  shaft_ = mechanics.shaft(0, state_.motion);
  block_ = mechanics.block(0, state_.motion);
  const auto pistons = static_cast<std::size_t>(oil.pistons());
  loads_.chamber_pressure.assign(pistons, 0.0);
  other_loads_ = loads_;
  const auto size = static_cast<std::size_t>(oil.states());
  oil_rates_.resize(size);
  other_rates_.resize(size);
  by_oil_.resize(size * size);
  by_loads_.resize(pistons);
  by_motion_.resize(active_.size() * active_.size());
  by_pressure_.resize(active_.size() * pistons);
  if (balances && size > 0) {
    work_scale_ = power_of_two(scales[kWorkOfLoads]);
    double energy = 0, mass = 0;
    oil.stored(0, shaft_, block_, state_.oil.data(), energy, mass);
    if (mass > 0) mass_scale_ = power_of_two(kCompressed * mass);
  }
}

void System::scaled(const SystemState& state, std::vector<double>& y) const {
  y.resize(scale_.size());
  pack(state, active_, scale_, y.data());
}

void System::unscaled(const double* y, SystemState& state) const {
  unpack(y, active_, scale_, state);
}

std::vector<int> System::event_functions() const {
  std::vector<int> directions = {1, -1};
  directions.resize(kContacts + contacts_.size(), 0);
  return directions;
}

void System::set(double time, const double* y) {
  unscaled(y, state_);
  shaft_ = mechanics_.shaft(time, state_.motion);
  block_ = mechanics_.block(time, state_.motion);
}

bool System::rates(double time, const double* y, double* dy) {
  set(time, y);
  if (!all_finite(y, scale_.size())) return false;
  if (!oil_rates_.empty() &&
      !oil_.rates(time, shaft_, block_, state_.oil.data(), oil_rates_.data()))
    return false;
  std::size_t i = 0;
  if (!active_.empty()) {
    oil_.loads(time, block_, state_.oil.data(), loads_);
    mechanics_.rates(time, state_.motion, loads_, motion_rates_);
    ++evaluations_;
    for (const std::size_t index : active_) {
      dy[i] = motion_rates_[index] / scale_[i];
      ++i;
    }
  }
  for (const double rate : oil_rates_) {
    dy[i] = rate / scale_[i];
    ++i;
  }
  return all_finite(dy, scale_.size());
}

bool System::moved(const double* y) const {
  if (std::abs(block_.angle - known_angle_) > kServesFor) return true;
  // The angle itself is block_.angle.
  for (int i = mechanics_.shaft_is_free() ? 1 : 0; i < motions_; ++i)
    if (std::abs(y[i] - known_at_[i]) > kServesForState) return true;
  return false;
}

// Rates of motion and works by states of motion, the oil's loads held, and by chamber pressures.
// The ports load the lands of the port plate, along the axis.
void System::find_mechanics(double time, const double* y, const double* dy) {
  const std::size_t rows = active_.size();
  oil_.loads(time, block_, state_.oil.data(), loads_);
  for (int j = 0; j < motions_; ++j) {
    MotionVector beside = state_.motion;
    beside[active_[j]] += kDifference * scale_[j];
    mechanics_.rates(time, beside, loads_, motion_rates_);
    ++evaluations_;
    for (std::size_t i = 0; i < rows; ++i)
      by_motion_[j * rows + i] = (motion_rates_[active_[i]] / scale_[i] - dy[i]) / kDifference;
  }
  double peak = 1e5;
  for (const double p : loads_.chamber_pressure) peak = std::max(peak, std::abs(p));
  other_loads_ = loads_;
  for (std::size_t k = 0; k < loads_.chamber_pressure.size(); ++k) {
    const double step = kPressureDifference * peak;
    other_loads_.chamber_pressure[k] += step;
    mechanics_.rates(time, state_.motion, other_loads_, motion_rates_);
    ++evaluations_;
    other_loads_.chamber_pressure[k] = loads_.chamber_pressure[k];
    for (std::size_t i = 0; i < rows; ++i)
      by_pressure_[k * rows + i] = (motion_rates_[active_[i]] / scale_[i] - dy[i]) / step;
  }
  known_ = true;
  known_at_.assign(y, y + motions_);
  known_angle_ = block_.angle;
}

void System::jacobian(double time, const double* y, const double* dy, bool again,
                      double* by_state) {
  const auto size = scale_.size();
  const std::size_t rows = active_.size();
  const std::size_t pistons = loads_.chamber_pressure.size();
  const std::size_t oils = oil_rates_.size();
  std::fill(by_state, by_state + size * size, 0.0);
  set(time, y);
  if (rows > 0 && (!known_ || again || moved(y))) find_mechanics(time, y, dy);
  if (rows > 0) oil_.loads(time, block_, state_.oil.data(), loads_);

  // Adds what a change of the pressures, by_loads_ per unit of a state, does to the motion.
  const auto add_by_pressures = [&](double* column) {
    for (std::size_t k = 0; k < pistons; ++k) {
      if (by_loads_[k] == 0) continue;
      for (std::size_t i = 0; i < rows; ++i) column[i] += by_pressure_[k * rows + i] * by_loads_[k];
    }
  };
  for (int j = 0; j < motions_; ++j) {
    double* column = by_state + j * size;
    std::copy_n(by_motion_.begin() + j * rows, rows, column);
    MotionVector beside = state_.motion;
    beside[active_[j]] += kDifference * scale_[j];
    const AxisMotion shaft = mechanics_.shaft(time, beside);
    const AxisMotion block = mechanics_.block(time, beside);
    if (shaft == shaft_ && block == block_) continue;
    if (oils > 0 && oil_.rates(time, shaft, block, state_.oil.data(), other_rates_.data()))
      for (std::size_t i = 0; i < oils; ++i)
        column[rows + i] = (other_rates_[i] / scale_[rows + i] - dy[rows + i]) / kDifference;
    if (block.angle == block_.angle) continue;
    oil_.loads(time, block, state_.oil.data(), other_loads_);
    for (std::size_t k = 0; k < pistons; ++k)
      by_loads_[k] = (other_loads_.chamber_pressure[k] - loads_.chamber_pressure[k]) / kDifference;
    add_by_pressures(column);
  }
  if (oils == 0) return;
  oil_.jacobian(time, shaft_, block_, state_.oil.data(), by_oil_.data());
  for (std::size_t j = 0; j < oils; ++j) {
    double* column = by_state + (rows + j) * size;
    const double scale = scale_[rows + j];
    for (std::size_t i = 0; i < oils; ++i)
      column[rows + i] = by_oil_[j * oils + i] * scale / scale_[rows + i];
    if (rows == 0) continue;
    const double held = state_.oil[j];
    state_.oil[j] += kDifference * scale;
    oil_.loads(time, block_, state_.oil.data(), other_loads_);
    state_.oil[j] = held;
    for (std::size_t k = 0; k < pistons; ++k)
      by_loads_[k] = (other_loads_.chamber_pressure[k] - loads_.chamber_pressure[k]) / kDifference;
    add_by_pressures(column);
  }
}

void System::integrands(double time, const double* y, double* dq) {
  set(time, y);
  oil_.loads(time, block_, state_.oil.data(), loads_);
  oil_.powers(time, shaft_, block_, state_.oil.data(), dq, dq[mass_in()], dq[mass_out()]);
  dq[pressure_work()] = mechanics_.pressure_power(time, state_.motion, loads_);
  for (int i = 0; i < integrals(); ++i) dq[i] /= integral_scale(i);
}

void System::event_values(double time, const double* y, double* values) {
  set(time, y);
  values[kTo] = block_.angle - to;
  values[kFrom] = block_.angle - from;
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    values[kContacts + i] = mechanics_.approach(time, state_.motion, contacts_[i]);
}

bool System::is_recoverable(const std::exception& error) const {
  return dynamic_cast<const ComputationError*>(&error) != nullptr;
}

}  // namespace bentaxis::coupled

#include "transmission_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/pump/units.h"

namespace bentaxis::hydraulics {
namespace {

double sign(int i) { return i % 2 == 0 ? 1 : -1; }  // P_i(-1)

// Integral of P_i' P_j over -1..1.
double slope_by_value(int i, int j) { return i > j && (i - j) % 2 == 1 ? 2 : 0; }

double sound(const DeliveryLineData& data, const Fluid::State& oil) {
  return data.wave_speed > 0 ? data.wave_speed
                             : std::sqrt(oil.stiffness * oil.pressure / oil.density);
}

}  // namespace

int TransmissionLine::degree(double bandwidth, double length, double wave_speed) {
  return static_cast<int>(std::ceil(2 * kPi * bandwidth * length / wave_speed + 2));
}

TransmissionLine::TransmissionLine(const DeliveryLineData& data, End end, const Fluid::State& oil,
                                   double viscosity)
    : end_(end),
      wave_speed_(sound(data, oil)),
      density_(oil.density),
      reference_(oil.pressure),
      flow_scale_(kPi / 4 * data.diameter * data.diameter * reference_ / wave_speed_),
      rate_(2 * wave_speed_ / data.length),
      friction_(32 * viscosity / (data.diameter * data.diameter)) {
  flows_ = degree(data.bandwidth, data.length, wave_speed_) + 1;
  // With both ends' pressures given, one mode of pressure more than of dm/dx would never move.
  pressures_ = end_ == End::given_flow ? flows_ : flows_ - 1;
}

double TransmissionLine::damping_of(int i) const {
  constexpr int kSteepness = 16;
  const int n = flows_ - 1;
  if (i < 2) return 0;
  return rate_ * (n + 0.5) * std::pow(static_cast<double>(i - 1) / (n - 1), kSteepness);
}

void TransmissionLine::uniform(double pressure, double flow, double* y) const {
  std::fill(y, y + size(), 0.0);
  y[0] = (pressure - reference_) / reference_;
  y[pressures_] = flow / flow_scale_;
}

double TransmissionLine::inflow(const double* y) const {
  double sum = 0;
  for (int j = 0; j < flows_; ++j) sum += sign(j) * y[pressures_ + j];
  return flow_scale_ * sum;
}

double TransmissionLine::end_pressure(const double* y) const {
  double sum = 0;
  for (int j = 0; j < pressures_; ++j) sum += y[j];
  return reference_ * (1 + sum);
}

Side TransmissionLine::end_side(const double* y) const {
  return {end_pressure(y), reference_, density_, std::numeric_limits<double>::infinity()};
}

double TransmissionLine::outflow(const double* y) const {
  double sum = 0;
  for (int j = 0; j < flows_; ++j) sum += y[pressures_ + j];
  return flow_scale_ * sum;
}

void TransmissionLine::rates(const double* y, double start, double end, double* dy) const {
  const double* p = y;
  const double* m = y + pressures_;
  const bool flow_given = end_ == End::given_flow;
  const double at_start = (start - reference_) / reference_;
  const double inflow = this->inflow(y) / flow_scale_;
  const double outflow = (flow_given ? end : this->outflow(y)) / flow_scale_;
  const double at_end = ((flow_given ? end_pressure(y) : end) - reference_) / reference_;
  // Integrals of P_i' p and P_i' m: twice the modes of the other parity below i.
  double p_below[2] = {0, 0}, m_below[2] = {0, 0};
  for (int i = 0; i < flows_; ++i) {
    const int other = 1 - i % 2;
    const double scale = scale_of(i);
    const double damping = damping_of(i);
    if (i < pressures_)
      dy[i] = scale * (sign(i) * inflow - outflow + 2 * m_below[other]) - damping * p[i];
    dy[pressures_ + i] =
        scale * (sign(i) * at_start - at_end + 2 * p_below[other]) - (friction_ + damping) * m[i];
    if (i < pressures_) p_below[i % 2] += p[i];
    m_below[i % 2] += m[i];
  }
}

double TransmissionLine::friction_power(const double* y) const {
  double sum = 0;
  for (int i = 0; i < flows_; ++i) sum += y[pressures_ + i] * y[pressures_ + i] / scale_of(i);
  return power_scale() * friction_ * sum;
}

double TransmissionLine::damped_power(const double* y) const {
  double sum = 0;
  for (int i = 2; i < flows_; ++i) {
    const double p = i < pressures_ ? y[i] : 0, m = y[pressures_ + i];
    sum += damping_of(i) * (p * p + m * m) / scale_of(i);
  }
  return power_scale() * sum;
}

double TransmissionLine::energy(const double* y) const {
  double sum = 0;
  for (int i = 0; i < flows_; ++i) {
    const double p = i < pressures_ ? y[i] : 0, m = y[pressures_ + i];
    sum += (p * p + m * m) / scale_of(i);
  }
  return power_scale() * sum / 2;
}

double TransmissionLine::mass(const double* y) const {
  const double per_mode = 2 * flow_scale_ / rate_;  // A L reference/c^2
  return per_mode * (y[0] + density_ * wave_speed_ * wave_speed_ / reference_);
}

double TransmissionLine::by_state(int i, int j) const {
  const bool pressure = i < pressures_, by_pressure = j < pressures_;
  const int row = pressure ? i : i - pressures_, column = by_pressure ? j : j - pressures_;
  if (pressure == by_pressure)
    return row != column ? 0 : -damping_of(row) - (pressure ? 0 : friction_);
  const double scale = scale_of(row);
  const bool flow_given = end_ == End::given_flow;
  double entry = slope_by_value(row, column);
  if (pressure)
    entry += sign(row) * sign(column) - (flow_given ? 0 : 1);
  else
    entry -= flow_given ? 1 : 0;
  return scale * entry;
}

double TransmissionLine::by_start(int i) const {
  if (i < pressures_) return 0;
  const int row = i - pressures_;
  return scale_of(row) * sign(row) / reference_;
}

double TransmissionLine::by_end(int i) const {
  const bool flow_given = end_ == End::given_flow;
  if (flow_given != (i < pressures_)) return 0;
  const int row = flow_given ? i : i - pressures_;
  return -scale_of(row) / (flow_given ? flow_scale_ : reference_);
}

}  // namespace bentaxis::hydraulics

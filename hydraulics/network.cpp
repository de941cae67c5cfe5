#include "network.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"

namespace bentaxis::hydraulics {
namespace {

// A stroke below this share of the piston's length is round-off, not a stroke.
constexpr double kNoStroke = 1e-9;
// Edges closer than this are one, degrees.
constexpr double kSameEdge = 1e-9;

double seconds_per_degree(const Case& the_case) {
  const double speed = the_case.operation.speed_rpm;
  const auto refuse = [&](const std::string& why) {
    throw InputError(the_case.file.string() + ": [operation] speed_rpm = " + number_text(speed) +
                     ": must be > 0 with [pressure] kind = \"hydraulic\": " + why);
  };
  if (speed == 0) refuse("at standstill there is no periodic pressure");
  if (speed < 0)
    refuse(
        "backwards the pump takes oil from the delivery line (motoring), which has "
        "a load and no supply here");
  return 1 / (6 * speed);
}

const HydraulicData& data_of(const Case& the_case) {
  if (!the_case.hydraulics)
    throw InputError(the_case.file.string() +
                     ": [pressure] kind must be \"hydraulic\", with a table [hydraulics]");
  return *the_case.hydraulics;
}

}  // namespace

Network::Network(const Case& the_case)
    : n_(validate(the_case).pump.geometry.pistons),
      open_(the_case.pressure.ports.delivery == 0),
      fluid_(data_of(the_case)),
      chamber_(the_case.pump.geometry, the_case.hydraulics->dead_volume),
      delivery_(*the_case.hydraulics, the_case.hydraulics->delivery,
                the_case.pump.geometry.bore_circle_radius),
      suction_(*the_case.hydraulics, the_case.hydraulics->suction,
               the_case.pump.geometry.bore_circle_radius),
      seconds_per_degree_(hydraulics::seconds_per_degree(the_case)),
      leakage_(the_case.hydraulics->leakage),
      delivery_volume_(the_case.hydraulics->delivery_volume),
      discharge_(the_case.hydraulics->discharge_coefficient),
      transition_squared_(the_case.hydraulics->transition_pressure *
                          the_case.hydraulics->transition_pressure),
      suction_s_(fluid_.log_pressure(the_case.pressure.ports.suction)),
      delivery_s_(fluid_.log_pressure(the_case.pressure.ports.delivery)),
      delivery_pressure_(the_case.pressure.ports.delivery),
      suction_state_(fluid_.state(suction_s_)),
      case_state_(fluid_.state(fluid_.log_pressure(the_case.hydraulics->case_pressure))),
      outside_(fluid_.state(0)) {
  const Geometry& g = the_case.pump.geometry;
  const double area = kPi / 4 * g.bore_diameter * g.bore_diameter;
  if (chamber_.swept() <= kNoStroke * area * g.piston_length)
    throw InputError(the_case.file.string() +
                     ": [pump] tilt_deg = " + number_text(g.tilt / kRadPerDegree) +
                     ": the pistons have no stroke, so that there is no displacement to compute a "
                     "hydraulic pressure from");
  // All chambers meet an edge at the same angle within the period.
  for (const auto* port : {&delivery_, &suction_})
    for (const double edge : port->edges_deg()) {
      const double within = std::fmod(edge, period_deg());
      if (within > kSameEdge && within < period_deg() - kSameEdge) edges_deg_.push_back(within);
    }
  std::sort(edges_deg_.begin(), edges_deg_.end());
  edges_deg_.erase(std::unique(edges_deg_.begin(), edges_deg_.end(),
                               [](double a, double b) { return b - a < kSameEdge; }),
                   edges_deg_.end());
}

Network::Flow Network::orifice(double area, const Fluid::State& first,
                               const Fluid::State& second) const {
  if (area == 0) return {};
  const double drop = first.pressure - second.pressure;
  const double square = drop * drop + transition_squared_;
  const double root = std::sqrt(std::sqrt(square));
  const double law = drop / root;
  const double slope = (drop * drop / 2 + transition_squared_) / (square * root);
  const double weight = std::sqrt(first.density + second.density);  // sqrt(2 mean density)
  const double by_density = discharge_ * area * law / (2 * weight);
  return {discharge_ * area * weight * law,
          discharge_ * area * weight * slope * first.pressure +
              by_density * first.density / first.stiffness,
          -discharge_ * area * weight * slope * second.pressure +
              by_density * second.density / second.stiffness};
}

Network::Flow Network::leak(const Fluid::State& chamber) const {
  const double drop = chamber.pressure - case_state_.pressure;
  const double density = (chamber.density + case_state_.density) / 2;
  return {leakage_ * density * drop,
          leakage_ * (density * chamber.pressure + drop * chamber.density / chamber.stiffness / 2),
          0};
}

double Network::load_area_for(double mass_flow) const {
  const Flow one = orifice(1, fluid_.state(delivery_s_), outside_);
  return mass_flow / one.value;
}

bool Network::rates(double x, const double* y, double load_area, double* dy) const {
  const Fluid::State line = open_ ? outside_ : fluid_.state(y[n_]);
  double delivered = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = angle_deg(x, k);
    const Chamber::Volume volume = chamber_.volume(radians(angle));
    const Fluid::State at = fluid_.state(y[k]);
    const double out = orifice(delivery_.area(angle), at, line).value;
    const double in = orifice(suction_.area(angle), suction_state_, at).value;
    const double mass = in - out - leak(at).value;
    delivered += out;
    dy[k] = at.stiffness *
            (seconds_per_degree_ * mass / at.density - kRadPerDegree * volume.slope) / volume.value;
    if (!std::isfinite(dy[k])) return false;
  }
  if (open_) return true;
  dy[n_] = line.stiffness * seconds_per_degree_ *
           (delivered - orifice(load_area, line, outside_).value) /
           (line.density * delivery_volume_);
  dy[n_ + 1] = (line.pressure - outside_.pressure) / (delivery_pressure_ * period_deg());
  return std::isfinite(dy[n_]) && std::isfinite(dy[n_ + 1]);
}

void Network::jacobian(double x, const double* y, double load_area, double* by_state,
                       double* by_load) const {
  const int size = this->size();
  std::fill(by_state, by_state + size * size, 0.0);
  std::fill(by_load, by_load + size, 0.0);
  const auto entry = [&](int row, int column) -> double& { return by_state[column * size + row]; };
  const Fluid::State line = open_ ? outside_ : fluid_.state(y[n_]);
  const double line_factor =
      line.stiffness * seconds_per_degree_ / (line.density * delivery_volume_);
  double delivered = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = angle_deg(x, k);
    const Chamber::Volume volume = chamber_.volume(radians(angle));
    const Fluid::State at = fluid_.state(y[k]);
    const Flow out = orifice(delivery_.area(angle), at, line);
    const Flow in = orifice(suction_.area(angle), suction_state_, at);
    const Flow lost = leak(at);
    const double mass = in.value - out.value - lost.value;
    const double by_own = in.by_second - out.by_first - lost.by_first;
    delivered += out.value;
    entry(k, k) =
        (at.d_stiffness * (seconds_per_degree_ * mass / at.density - kRadPerDegree * volume.slope) +
         at.stiffness * seconds_per_degree_ * (by_own - mass / at.stiffness) / at.density) /
        volume.value;
    if (open_) continue;
    entry(k, n_) =
        -at.stiffness * seconds_per_degree_ * out.by_second / (at.density * volume.value);
    entry(n_, k) = line_factor * out.by_first;
    entry(n_, n_) += line_factor * out.by_second;
  }
  if (open_) return;
  const Flow load = orifice(load_area, line, outside_);
  // The factor K/P/density itself: its logarithmic derivative is (K/P)'/(K/P) - 1/(K/P).
  entry(n_, n_) += line_factor * (-load.by_first + (delivered - load.value) *
                                                       (line.d_stiffness - 1) / line.stiffness);
  entry(n_ + 1, n_) = line.pressure / (delivery_pressure_ * period_deg());
  by_load[n_] = -line_factor * load.value;
}

void Network::flows(double x, const double* y, double load_area, Flows& flows) const {
  flows.suction.resize(n_);
  flows.delivery.resize(n_);
  flows.leakage.resize(n_);
  const Fluid::State line = open_ ? outside_ : fluid_.state(y[n_]);
  flows.load = 0;
  flows.power = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = angle_deg(x, k);
    const Fluid::State at = fluid_.state(y[k]);
    flows.delivery[k] = orifice(delivery_.area(angle), at, line).value;
    flows.suction[k] = orifice(suction_.area(angle), suction_state_, at).value;
    flows.leakage[k] = leak(at).value;
    flows.load += flows.delivery[k];
    flows.power -= fluid_.gauge(y[k]) * chamber_.volume(radians(angle)).slope * kRadPerDegree /
                   seconds_per_degree_;
  }
  if (!open_) flows.load = orifice(load_area, line, outside_).value;
}

}  // namespace bentaxis::hydraulics

#include "network.h"

#include <algorithm>
#include <cmath>
#include <string>

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
// Of a delivery line: beyond, a search takes minutes.
constexpr int kMostModes = 48;

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

bool finite(const double* from, const double* to) {
  return std::all_of(from, to, [](double x) { return std::isfinite(x); });
}

LoadData load_of(const Case& the_case) { return data_of(the_case).load.value_or(LoadData()); }

double kinematic_viscosity(const HydraulicData& data) {
  return data.oil ? Viscosity(*data.oil, data.density).kinematic() : 0;
}

}  // namespace

Network::Network(const Case& the_case)
    : n_(validate(the_case).pump.geometry.pistons),
      fixed_end_(the_case.pressure.ports.delivery == 0 ||
                 load_of(the_case).kind == LoadKind::constant_pressure),
      fluid_(data_of(the_case)),
      chamber_(the_case.pump.geometry, the_case.hydraulics->dead_volume),
      delivery_(*the_case.hydraulics, the_case.hydraulics->delivery,
                the_case.pump.geometry.bore_circle_radius),
      suction_(*the_case.hydraulics, the_case.hydraulics->suction,
               the_case.pump.geometry.bore_circle_radius),
      seconds_per_degree_(hydraulics::seconds_per_degree(the_case)),
      delivery_volume_(the_case.hydraulics->delivery_volume),
      orifice_{the_case.hydraulics->discharge_coefficient,
               the_case.hydraulics->transition_pressure * the_case.hydraulics->transition_pressure},
      leakage_(the_case, fluid_, chamber_),
      suction_s_(fluid_.log_pressure(the_case.pressure.ports.suction)),
      delivery_s_(fluid_.log_pressure(the_case.pressure.ports.delivery)),
      delivery_pressure_(the_case.pressure.ports.delivery),
      mean_scale_(delivery_pressure_ > 0 ? delivery_pressure_ : fluid_.atmosphere()),
      suction_state_(fluid_.state(suction_s_)),
      fixed_state_(fluid_.state(delivery_s_)),
      outside_(fluid_.state(0)),
      case_potential_(fluid_.potential(fluid_.log_pressure(the_case.hydraulics->case_pressure))),
      suction_potential_(fluid_.potential(suction_s_)),
      fixed_potential_(fluid_.potential(delivery_s_)),
      load_(load_of(the_case), orifice_, fluid_, suction_state_.density * load_of(the_case).flow),
      fixed_(fixed_end_ && !the_case.hydraulics->delivery_line),
      sought_(!fixed_end_ && load_.sought()),
      release_time_(the_case.hydraulics->release_time),
      dissolution_time_(the_case.hydraulics->dissolution_time),
      case_s_(fluid_.log_pressure(the_case.hydraulics->case_pressure)) {
  const Geometry& g = the_case.pump.geometry;
  const double area = kPi / 4 * g.bore_diameter * g.bore_diameter;
  if (chamber_.swept() <= kNoStroke * area * g.piston_length)
    throw InputError(the_case.file.string() +
                     ": [pump] tilt_deg = " + number_text(g.tilt / kRadPerDegree) +
                     ": the pistons have no stroke, so that there is no displacement to compute a "
                     "hydraulic pressure from");
  const HydraulicData& data = *the_case.hydraulics;
  if (load_.kind() == LoadKind::flow && !fixed_end_ &&
      !(data.load->flow > 0 && data.load->flow * suction_state_.density < ideal_mass_flow()))
    throw InputError(the_case.file.string() +
                     ": [load] flow_l_per_min = " + number_text(data.load->flow / kLitrePerMinute) +
                     ": must be above 0 and below what the pump displaces, " +
                     number_text(ideal_mass_flow() / suction_state_.density / kLitrePerMinute) +
                     " l/min");
  states_ = pressures();
  if (data.suction_line) {
    suction_line_.emplace(*data.suction_line, suction_state_, kinematic_viscosity(data));
    suction_volume_ = data.suction_line->volume;
    suction_at_ = states_;
    states_ += 2;
  }
  if (data.delivery_line) {
    using End = TransmissionLine::End;
    pipe_.emplace(*data.delivery_line, fixed_end_ ? End::given_pressure : End::given_flow,
                  fixed_state_, kinematic_viscosity(data));
    if (pipe_->size() > kMostModes)
      throw InputError(the_case.file.string() + ": [delivery_line] bandwidth_Hz = " +
                       number_text(data.delivery_line->bandwidth) + ": takes " +
                       std::to_string(pipe_->size()) + " modes, more than " +
                       std::to_string(kMostModes) + ": lower it, or length_m");
    pipe_at_ = states_;
    states_ += pipe_->size();
  }
  if (data.cavitation == Cavitation::rate && data.dissolved_air > 0) {
    air_at_ = states_;
    states_ += n_;
  }
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

double Network::ideal_mass_flow() const {
  return suction_state_.density * displacement() / (360 * seconds_per_degree_);
}

double Network::load_size_for(double mass_flow) const {
  return load_.sought() ? load_.size_for(mass_flow, fixed_state_) : load_.size();
}

std::vector<double> Network::uniform(double chambers, double delivery, double mass_flow) const {
  std::vector<double> y(states_, chambers);
  if (!fixed_) y[n_] = delivery;
  if (suction_line_) {
    y[suction_at_] = suction_s_;
    y[suction_at_ + 1] = mass_flow / ideal_mass_flow();
  }
  if (pipe_) pipe_->uniform(fluid_.state(delivery).pressure, mass_flow, y.data() + pipe_at_);
  if (air_at_ > 0) std::fill(y.begin() + air_at_, y.end(), fluid_.equilibrium(chambers).value);
  return y;
}

double Network::load_gauge(const double* y) const {
  if (fixed_end_) return delivery_pressure_;
  return pipe_ ? pipe_->end_pressure(y + pipe_at_) - fluid_.atmosphere() : delivery_gauge(y);
}

double Network::to_load(const double* y, const Fluid::State& line, double load_size) const {
  if (!pipe_) return load_.flow(line, load_size).value;
  const double* modes = y + pipe_at_;
  if (fixed_end_) return pipe_->outflow(modes);
  return load_.flow(pipe_->end_side(modes), load_size).value;
}

Network::Sources Network::sources(const double* y) const {
  if (air_at_ == 0) return {};
  return {fluid_.equilibrium(suction_line_ ? y[suction_at_] : suction_s_),
          fluid_.equilibrium(fixed_ ? delivery_s_ : y[n_]), fluid_.equilibrium(case_s_)};
}

Network::ChamberFlows Network::chamber_flows(double angle_deg, double volume,
                                             const Fluid::Mixture& at, const Fluid::State& source,
                                             const Fluid::State& line) const {
  ChamberFlows flows{orifice_.flow(suction_.area(angle_deg), source, at),
                     orifice_.flow(delivery_.area(angle_deg), at, line), leakage_.flow(at, volume)};
  if (at.swelling != 0) {
    // All depend on the sum of both densities, by its root or in proportion.
    const double thinner = -at.density * at.swelling;
    flows.in_by_air = flows.in.value * thinner / (2 * (at.density + source.density));
    flows.out_by_air = flows.out.value * thinner / (2 * (at.density + line.density));
    flows.lost_by_air = flows.lost.value * thinner / (at.density + fluid_.state(case_s_).density);
  }
  return flows;
}

Network::AirRate Network::release(double s, double air_out) const {
  const Fluid::AirOut wanted = fluid_.equilibrium(s);
  const double time = air_out < wanted.value ? release_time_ : dissolution_time_;
  return {(wanted.value - air_out) / time, wanted.slope / time, -1 / time};
}

Network::AirRate Network::air_rate(double s, double air_out, const Fluid::Mixture& at,
                                   double volume, const ChamberFlows& flows,
                                   const Sources& from) const {
  const double per_mass = 1 / (at.density * volume);
  AirRate rate = release(s, air_out);
  double brought = 0, by_air = 0, by_pressure = 0;
  // Oil that comes in brings its own air: `sign` x flow > 0.
  const auto bring = [&](const MassFlow& flow, double sign, double by_own, double flow_by_air,
                         double by_source, const Fluid::AirOut& source, double* with_source) {
    const double in = sign * flow.value;
    if (!(in > 0)) return;
    const double more = source.value - air_out;
    brought += in * more;
    by_pressure += sign * by_own * more;
    by_air += sign * flow_by_air * more - in;
    if (with_source != nullptr)
      *with_source = per_mass * (sign * by_source * more + in * source.slope);
  };
  bring(flows.in, 1, flows.in.by_second, flows.in_by_air, flows.in.by_first, from.suction,
        &rate.by_suction);
  bring(flows.out, -1, flows.out.by_first, flows.out_by_air, flows.out.by_second, from.delivery,
        &rate.by_delivery);
  bring(flows.lost, -1, flows.lost.by_first, flows.lost_by_air, 0, from.outside, nullptr);
  rate.value += per_mass * brought;
  rate.by_pressure += per_mass * (by_pressure - brought / at.stiffness);
  rate.by_air += per_mass * (by_air + brought * at.swelling);
  for (double* one :
       {&rate.value, &rate.by_pressure, &rate.by_air, &rate.by_suction, &rate.by_delivery})
    *one *= seconds_per_degree_;
  return rate;
}

bool Network::rates(double x, const double* y, double load_size, double* dy) const {
  const Fluid::State line = fixed_ ? fixed_state_ : fluid_.state(y[n_]);
  const Fluid::State source = suction_line_ ? fluid_.state(y[suction_at_]) : suction_state_;
  const Sources from = sources(y);
  double delivered = 0, taken = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = angle_deg(x, k);
    const Chamber::Volume volume = chamber_.volume(radians(angle));
    const Fluid::Mixture at = mixture(y, k);
    const ChamberFlows flows = chamber_flows(angle, volume.value, at, source, line);
    const double mass = flows.in.value - flows.out.value - flows.lost.value;
    delivered += flows.out.value;
    taken += flows.in.value;
    dy[k] = at.stiffness *
            (seconds_per_degree_ * mass / at.density - kRadPerDegree * volume.slope) / volume.value;
    if (air_at_ > 0) {
      dy[air_at_ + k] = air_rate(y[k], y[air_at_ + k], at, volume.value, flows, from).value;
      dy[k] += at.stiffness * at.swelling * dy[air_at_ + k];
    }
    if (!std::isfinite(dy[k])) return false;
  }
  if (suction_line_) {
    const double flow = y[suction_at_ + 1] * ideal_mass_flow();
    dy[suction_at_] = source.stiffness * seconds_per_degree_ * (flow - taken) /
                      (source.density * suction_volume_);
    dy[suction_at_ + 1] =
        seconds_per_degree_ * suction_line_->rate(source.pressure, flow) / ideal_mass_flow();
  }
  if (fixed_) return finite(dy + n_, dy + size());
  const double load = to_load(y, line, load_size);
  const double leaves = pipe_ ? pipe_->inflow(y + pipe_at_) : load;
  dy[n_] = line.stiffness * seconds_per_degree_ * (delivered - leaves) /
           (line.density * delivery_volume_);
  dy[size() - 1] = (line.pressure - outside_.pressure) / (mean_scale_ * period_deg());
  if (pipe_) {
    double* modes = dy + pipe_at_;
    pipe_->rates(y + pipe_at_, line.pressure, fixed_end_ ? fixed_state_.pressure : load, modes);
    for (int i = 0; i < pipe_->size(); ++i) modes[i] *= seconds_per_degree_;
  }
  return finite(dy + n_, dy + size());
}

void Network::jacobian(double x, const double* y, double load_size, double* by_state,
                       double* by_load) const {
  const int size = this->size();
  std::fill(by_state, by_state + size * size, 0.0);
  std::fill(by_load, by_load + size, 0.0);
  const auto entry = [&](int row, int column) -> double& { return by_state[column * size + row]; };
  const Fluid::State line = fixed_ ? fixed_state_ : fluid_.state(y[n_]);
  const Fluid::State source = suction_line_ ? fluid_.state(y[suction_at_]) : suction_state_;
  const double line_factor =
      line.stiffness * seconds_per_degree_ / (line.density * delivery_volume_);
  const double source_factor =
      suction_line_ ? source.stiffness * seconds_per_degree_ / (source.density * suction_volume_)
                    : 0;
  const Sources from = sources(y);
  double delivered = 0, taken = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = angle_deg(x, k);
    const Chamber::Volume volume = chamber_.volume(radians(angle));
    const Fluid::Mixture at = mixture(y, k);
    const ChamberFlows flows = chamber_flows(angle, volume.value, at, source, line);
    const auto& [in, out, lost, in_by_air, out_by_air, lost_by_air] = flows;
    const double mass = in.value - out.value - lost.value;
    const double by_own = in.by_second - out.by_first - lost.by_first;
    delivered += out.value;
    taken += in.value;
    entry(k, k) =
        (at.d_stiffness * (seconds_per_degree_ * mass / at.density - kRadPerDegree * volume.slope) +
         at.stiffness * seconds_per_degree_ * (by_own - mass / at.stiffness) / at.density) /
        volume.value;
    const double by_mass = at.stiffness * seconds_per_degree_;
    if (suction_line_) {
      entry(k, suction_at_) = by_mass * in.by_first / (at.density * volume.value);
      entry(suction_at_, k) = -source_factor * in.by_second;
      entry(suction_at_, suction_at_) -= source_factor * in.by_first;
    }
    if (!fixed_) {
      entry(k, n_) = -by_mass * out.by_second / (at.density * volume.value);
      entry(n_, k) = line_factor * out.by_first;
      entry(n_, n_) += line_factor * out.by_second;
    }
    if (air_at_ == 0) continue;
    const int a = air_at_ + k;
    const AirRate air = air_rate(y[k], y[a], at, volume.value, flows, from);
    entry(a, k) = air.by_pressure;
    entry(a, a) = air.by_air;
    // ds/dx is stiffness x (drive + swelling x d(air out)/dx).
    const double drive =
        (seconds_per_degree_ * mass / at.density - kRadPerDegree * volume.slope) / volume.value;
    const double swells = at.stiffness * at.swelling;
    entry(k, k) += (at.d_stiffness * at.swelling + at.stiffness * at.d_swelling) * air.value +
                   swells * air.by_pressure;
    entry(k, a) = at.stiffness_by_air * (drive + at.swelling * air.value) +
                  by_mass * (in_by_air - out_by_air - lost_by_air + mass * at.swelling) /
                      (at.density * volume.value) +
                  at.stiffness * at.swelling_by_air * air.value + swells * air.by_air;
    if (suction_line_) {
      entry(a, suction_at_) = air.by_suction;
      entry(k, suction_at_) += swells * air.by_suction;
      entry(suction_at_, a) = -source_factor * in_by_air;
    }
    if (!fixed_) {
      entry(a, n_) = air.by_delivery;
      entry(k, n_) += swells * air.by_delivery;
      entry(n_, a) = line_factor * out_by_air;
    }
  }
  // The factor K/P/density of a volume itself: its logarithmic derivative is (K/P)'/(K/P) -
  // 1/(K/P).
  if (suction_line_) {
    const int s = suction_at_, m = suction_at_ + 1;
    const double flow = y[m] * ideal_mass_flow();
    entry(s, s) += source_factor * (flow - taken) * (source.d_stiffness - 1) / source.stiffness;
    entry(s, m) = source_factor * ideal_mass_flow();
    entry(m, s) =
        seconds_per_degree_ * suction_line_->by_port() * source.pressure / ideal_mass_flow();
    entry(m, m) = seconds_per_degree_ * suction_line_->by_flow(flow);
  }
  if (fixed_) return;
  entry(size - 1, n_) = line.pressure / (mean_scale_ * period_deg());
  if (!pipe_) {
    const Load::Flow load = load_.flow(line, load_size);
    entry(n_, n_) += line_factor * (-load.by_side + (delivered - load.value) *
                                                        (line.d_stiffness - 1) / line.stiffness);
    by_load[n_] = -line_factor * load.by_size;
    return;
  }
  const double* modes = y + pipe_at_;
  entry(n_, n_) +=
      line_factor * ((delivered - pipe_->inflow(modes)) * (line.d_stiffness - 1) / line.stiffness);
  // What is given at the far end follows from the pressure there, which is that of every mode.
  const Load::Flow load = fixed_end_ ? Load::Flow() : load_.flow(pipe_->end_side(modes), load_size);
  for (int i = 0; i < pipe_->size(); ++i) {
    const int row = pipe_at_ + i;
    for (int j = 0; j < pipe_->size(); ++j)
      entry(row, pipe_at_ + j) =
          seconds_per_degree_ *
          (pipe_->by_state(i, j) + (j < pipe_->pressures() ? pipe_->by_end(i) * load.by_side : 0));
    entry(row, n_) = seconds_per_degree_ * pipe_->by_start(i) * line.pressure;
    by_load[row] = seconds_per_degree_ * pipe_->by_end(i) * load.by_size;
  }
  for (int j = pipe_->pressures(); j < pipe_->size(); ++j)
    entry(n_, pipe_at_ + j) = -line_factor * pipe_->inflow_by(j - pipe_->pressures());
}

void Network::flows(double x, const double* y, double load_size, Flows& flows) const {
  flows.suction.resize(n_);
  flows.delivery.resize(n_);
  flows.leakage.resize(n_);
  const Fluid::State line = fixed_ ? fixed_state_ : fluid_.state(y[n_]);
  const Fluid::State source = suction_line_ ? fluid_.state(y[suction_at_]) : suction_state_;
  flows.load = 0;
  flows.power = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = angle_deg(x, k);
    const Chamber::Volume volume = chamber_.volume(radians(angle));
    const Fluid::State at = mixture(y, k);
    flows.delivery[k] = orifice_.flow(delivery_.area(angle), at, line).value;
    flows.suction[k] = orifice_.flow(suction_.area(angle), source, at).value;
    flows.leakage[k] = leakage_.flow(at, volume.value).value;
    flows.load += flows.delivery[k];
    flows.power -= fluid_.gauge(y[k]) * volume.slope * kRadPerDegree / seconds_per_degree_;
  }
  if (!fixed_) flows.load = to_load(y, line, load_size);
}

double Network::load_flow(double x, const double* y, double load_size) const {
  if (!fixed_) return to_load(y, fluid_.state(y[n_]), load_size);
  double sum = 0;
  for (int k = 0; k < n_; ++k)
    sum += orifice_.flow(delivery_.area(angle_deg(x, k)), fluid_.state(y[k]), fixed_state_).value;
  return sum;
}

PowerBudget Network::power(double x, const double* y, const Flows& flows) const {
  PowerBudget power;
  power[Place::pistons] = flows.power;
  const double line = fixed_ ? fixed_potential_ : fluid_.potential(y[n_]);
  const double source = suction_line_ ? fluid_.potential(y[suction_at_]) : suction_potential_;
  const Sources from = sources(y);
  double taken = 0;
  for (int k = 0; k < n_; ++k) {
    const Fluid::Mixture at = mixture(y, k);
    const double volume = chamber_.volume(radians(angle_deg(x, k))).value;
    const double in = flows.suction[k], out = flows.delivery[k], lost = flows.leakage[k];
    // What comes in brings the air that is out where it comes from.
    const double air = air_at_ > 0 ? y[air_at_ + k] : 0;
    const double by_air = air_at_ > 0 ? fluid_.potential_by_air(y[k]) : 0;
    const double own = air_at_ > 0 ? fluid_.potential(y[k], air) : fluid_.potential(y[k]);
    const auto potential = [&](bool comes_in, const Fluid::AirOut& there) {
      return comes_in ? own + by_air * (there.value - air) : own;
    };
    power[in < 0 ? Place::suction_backflow : Place::suction_port] +=
        in * (source - potential(in > 0, from.suction));
    power[out < 0 ? Place::delivery_backflow : Place::delivery_port] +=
        out * (potential(out < 0, from.delivery) - line);
    if (air_at_ > 0) power[Place::air] -= at.density * volume * by_air * release(y[k], air).value;
    const Leakage::Parts parts = leakage_.parts(at, volume);
    const double drop = potential(lost < 0, from.outside) - case_potential_;
    power[Place::conductance] += parts.conductance * drop;
    power[Place::piston_gap] += parts.piston_gap * drop;
    power[Place::plate_gap] += parts.plate_gap * drop;
    power[Place::ring_slot] += parts.ring_slot * drop;
    power[Place::drain] += lost * case_potential_;
    taken += in;
  }
  // In a line the oil has one density: its potential there is linear in the pressure.
  if (suction_line_) {
    taken = y[suction_at_ + 1] * ideal_mass_flow();
    const double drop = fluid_.state(y[suction_at_]).pressure - suction_state_.pressure;
    power[Place::suction_line] = suction_line_->lost(taken);
    power[Place::line_density] +=
        taken * (suction_potential_ + drop / suction_state_.density - source);
  }
  power[Place::tank] = taken * suction_potential_;
  power[Place::load] = flows.load * line;
  if (pipe_) {
    const double* modes = y + pipe_at_;
    const auto within = [&](double pressure) {
      return fixed_potential_ + (pressure - fixed_state_.pressure) / fixed_state_.density;
    };
    const double end = fixed_end_ ? fixed_state_.pressure : pipe_->end_pressure(modes);
    power[Place::load] = flows.load * within(end);
    power[Place::delivery_line] = pipe_->friction_power(modes);
    power[Place::damped_waves] = pipe_->damped_power(modes);
    power[Place::line_density] +=
        pipe_->inflow(modes) * (line - within(fluid_.state(y[n_]).pressure));
  }
  return power;
}

std::vector<Place> Network::places() const {
  std::vector<Place> all = {Place::pistons, Place::tank, Place::load, Place::drain};
  if (suction_line_) all.push_back(Place::suction_line);
  for (const Place port : {Place::suction_port, Place::suction_backflow, Place::delivery_port,
                           Place::delivery_backflow})
    all.push_back(port);
  if (leakage_.has_conductance()) all.push_back(Place::conductance);
  if (leakage_.has_piston_gap()) all.push_back(Place::piston_gap);
  if (leakage_.has_plate_gap()) all.push_back(Place::plate_gap);
  if (leakage_.has_ring_slot()) all.push_back(Place::ring_slot);
  if (pipe_) {
    all.push_back(Place::delivery_line);
    all.push_back(Place::damped_waves);
  }
  if (air_at_ > 0) all.push_back(Place::air);
  if (pipe_ || suction_line_) all.push_back(Place::line_density);
  return all;
}

}  // namespace bentaxis::hydraulics

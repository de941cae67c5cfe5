#include "network.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/delivery_side.h"
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
constexpr int kMaxModes = 48;

// Largest delivery pressure of a case, Pa.
constexpr double kHighestPressure = 1e9;
// What motion in time is measured by where the case says standstill, 1/min.
constexpr double kUsualSpeed = 1500;

const HydraulicData& data_of(const Case& the_case) {
  if (!the_case.hydraulics)
    throw InputError(the_case.file.string() +
                     ": [pressure] kind must be \"hydraulic\", with a table [hydraulics]");
  return *the_case.hydraulics;
}

LoadData load_of(const Case& the_case) { return data_of(the_case).load.value_or(LoadData()); }

double seconds_per_degree(const Case& the_case, Network::Use use) {
  const double speed = the_case.operation.speed_rpm;
  if (use == Network::Use::time) return 1 / (6 * (speed != 0 ? std::abs(speed) : kUsualSpeed));
  const auto refuse = [&](const std::string& why) {
    throw InputError(the_case.file.string() + ": [operation] speed_rpm = " + number_text(speed) +
                     ": refused with [pressure] kind = \"hydraulic\": " + why);
  };
  if (speed == 0) refuse("at standstill there is no periodic pressure");
  if (speed < 0 && !delivery_is_held(the_case) && !load_of(the_case).sets_pressure())
    refuse(
        "backwards the pump takes oil from the delivery line (motoring), and no size of a load "
        "gives "
        "delivery_bar there: a supply does ([load] kind = \"constant_pressure\"), or a size of "
        "[load] is to be given, in a [loop] say");
  return 1 / (6 * std::abs(speed));
}

bool finite(const double* from, const double* to) {
  return std::all_of(from, to, [](double x) { return std::isfinite(x); });
}

double kinematic_viscosity(const HydraulicData& data) {
  return data.oil ? Viscosity(*data.oil, data.density).kinematic() : 0;
}

}  // namespace

Network::Held::Held(const Fluid& fluid, double pressure)
    : gauge(pressure),
      s(fluid.log_pressure(pressure)),
      state(fluid.state(s)),
      potential(fluid.potential(s)) {}

Network::Network(const Case& the_case, Use use)
    : use_(use),
      direction_(use == Use::period && the_case.operation.speed_rpm < 0 ? -1 : 1),
      n_(validate(the_case).pump.geometry.pistons),
      fixed_end_(delivery_is_held(the_case)),
      fluid_(data_of(the_case)),
      chamber_(the_case.pump.geometry, the_case.hydraulics->dead_volume),
      delivery_(*the_case.hydraulics, the_case.hydraulics->delivery,
                the_case.pump.geometry.bore_circle_radius),
      suction_(*the_case.hydraulics, the_case.hydraulics->suction,
               the_case.pump.geometry.bore_circle_radius),
      seconds_per_degree_(hydraulics::seconds_per_degree(the_case, use)),
      delivery_volume_(the_case.hydraulics->delivery_volume),
      orifice_{the_case.hydraulics->discharge_coefficient,
               the_case.hydraulics->transition_pressure * the_case.hydraulics->transition_pressure},
      leakage_(the_case, fluid_, chamber_),
      suction_s_(fluid_.log_pressure(the_case.pressure.ports.suction)),
      delivery_s_(fluid_.log_pressure(the_case.pressure.ports.delivery)),
      suction_pressure_(the_case.pressure.ports.suction),
      delivery_pressure_(the_case.pressure.ports.delivery),
      mean_scale_(delivery_pressure_ > 0 ? delivery_pressure_ : fluid_.atmosphere()),
      suction_state_(fluid_.state(suction_s_)),
      fixed_state_(fluid_.state(delivery_s_)),
      outside_(fluid_.state(0)),
      case_potential_(fluid_.potential(fluid_.log_pressure(the_case.hydraulics->case_pressure))),
      fixed_potential_(fluid_.potential(delivery_s_)),
      tank_(fluid_, the_case.pressure.ports.suction),
      end_(fluid_, the_case.pressure.ports.delivery),
      load_(load_of(the_case), orifice_, fluid_, suction_state_.density * load_of(the_case).flow,
            the_case.hydraulics->loop.has_value()),
      loop_(the_case.hydraulics->loop.has_value()),
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
  if (use == Use::period && load_.kind() == LoadKind::flow && !fixed_end_ && !backwards() &&
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
  if (loop_) {
    suction_volume_ = data.loop->volume;
    charge_area_ = data.loop->charge_area;
    charge_opening_ = data.loop->opening;
    suction_at_ = states_++;
  }
  if (data.delivery_line) {
    using End = TransmissionLine::End;
    pipe_.emplace(*data.delivery_line, fixed_end_ ? End::given_pressure : End::given_flow,
                  fixed_state_, kinematic_viscosity(data));
    if (pipe_->size() > kMaxModes)
      throw InputError(the_case.file.string() + ": [delivery_line] bandwidth_Hz = " +
                       number_text(data.delivery_line->bandwidth) + ": takes " +
                       std::to_string(pipe_->size()) + " modes, more than " +
                       std::to_string(kMaxModes) + ": lower it, or length_m");
    pipe_at_ = states_;
    states_ += pipe_->size();
  }
  if (data.accumulator) {
    accumulator_.emplace(*data.accumulator, fluid_);
    inlet_area_ = data.accumulator->inlet_area;
    accumulator_at_ = states_++;
  }
  if (data.cavitation == Cavitation::rate && data.dissolved_air > 0) {
    air_at_ = states_;
    states_ += n_;
  }
  // All chambers meet an edge at the same angle within the period.
  for (const auto* port : {&delivery_, &suction_})
    for (const double edge : port->edges_deg()) {
      const double turned = std::fmod(edge, period_deg());
      const double within = backwards() ? period_deg() - turned : turned;
      if (within > kSameEdge && within < period_deg() - kSameEdge) edges_deg_.push_back(within);
    }
  std::sort(edges_deg_.begin(), edges_deg_.end());
  edges_deg_.erase(std::unique(edges_deg_.begin(), edges_deg_.end(),
                               [](double a, double b) { return b - a < kSameEdge; }),
                   edges_deg_.end());
}

void Network::set_suction(std::optional<double> gauge) {
  const double now = gauge.value_or(suction_pressure_);
  if (now == tank_.gauge) return;
  tank_ = Held(fluid_, now);
  if (suction_line_) suction_line_->set_tank(tank_.state);
}

void Network::set_delivery(std::optional<double> gauge) {
  const double now = gauge.value_or(delivery_pressure_);
  if (now != end_.gauge) end_ = Held(fluid_, now);
}

Network::Moment Network::at(double x) const {
  return {direction_ * x, seconds_per_degree_, direction_ * kRadPerDegree, {}, {}, true};
}

Network::Moment Network::at(const AxisMotion& shaft, const AxisMotion& block) {
  return {block.angle / kRadPerDegree, 1, 1, shaft, block, false};
}

Chamber::Volume Network::volume(const Moment& now, int k) const {
  if (now.locked) return chamber_.volume(radians(chamber_deg(now.block_deg, k)));
  const double behind = 2 * kPi * k / n_;
  const Chamber::Turned turned =
      chamber_.volume(now.shaft.angle - behind, now.block.angle - behind);
  return {turned.value, turned.by_joint * now.shaft.speed + turned.by_bore * now.block.speed};
}

double Network::ideal_mass_flow() const {
  return suction_state_.density * displacement() / (360 * seconds_per_degree_);
}

double Network::load_size_for(double mass_flow) const {
  return load_.sought() ? load_.size_for(mass_flow, fixed_state_, loop_ ? suction_state_ : outside_)
                        : load_.size();
}

std::vector<double> Network::uniform(double chambers, double delivery, double mass_flow) const {
  std::vector<double> y(states_, chambers);
  if (!fixed_) y[n_] = delivery;
  if (has_suction_volume()) y[suction_at_] = suction_s_;
  if (suction_line_) y[suction_at_ + 1] = mass_flow / ideal_mass_flow();
  if (accumulator_) y[accumulator_at_] = delivery;
  if (pipe_) pipe_->uniform(fluid_.state(delivery).pressure, mass_flow, y.data() + pipe_at_);
  if (air_at_ > 0) std::fill(y.begin() + air_at_, y.end(), fluid_.equilibrium(chambers).value);
  return y;
}

double Network::expected_log_pressure(double share) const {
  if (!loop_ || load_.sought()) return delivery_s_;
  constexpr int kHalvings = 50;
  const auto takes_it = [&](double s) {
    const double flow = load_.flow(fluid_.state(s), suction_state_, load_.size()).value;
    return !(flow < share * ideal_mass_flow());
  };
  return numerics::bisect({suction_s_, fluid_.log_pressure(kHighestPressure)}, kHalvings, takes_it)
      .middle();
}

std::vector<OilColumn> Network::state_columns() const {
  std::vector<OilColumn> all(static_cast<std::size_t>(states_));
  const auto name = [&](int at, const std::string& called, const std::string& meaning) {
    all[static_cast<std::size_t>(at)] = {called, meaning};
  };
  for (int k = 0; k < n_; ++k) {
    const std::string number = std::to_string(k + 1);
    name(k, "ln_p_" + number, "ln(P/P0) in chamber " + number + ", P absolute, P0 atmospheric");
    if (air_at_ > 0)
      name(air_at_ + k, "air_out_" + number,
           "share of the dissolved air that is out in chamber " + number);
  }
  if (!fixed_) name(n_, "ln_p_delivery", "ln(P/P0) in the delivery volume");
  if (has_suction_volume()) name(suction_at_, "ln_p_suction", "ln(P/P0) in the suction port");
  if (suction_line_)
    name(suction_at_ + 1, "flow_suction_line", "mass flow in the suction line over the ideal one");
  if (accumulator_) name(accumulator_at_, "ln_p_accumulator", "ln(P/P0) in the accumulator");
  for (int i = 0; pipe_ && i < pipe_->size(); ++i)
    name(pipe_at_ + i, "delivery_line_" + std::to_string(i + 1),
         "mode of the delivery line's pressure, then of its flow");
  return all;
}

std::vector<int> Network::order_after_period() const {
  std::vector<int> order(static_cast<std::size_t>(states_));
  std::iota(order.begin(), order.end(), 0);
  for (const int first : by_chamber())
    for (int k = 0; k < n_; ++k) order[first + next_of(k)] = first + k;
  return order;
}

void Network::exchange_sides(double* y) const {
  const double suction = y[suction_at_], delivery = y[n_];
  for (int k = 0; k < n_; ++k) y[k] = y[k] == suction ? delivery : suction;
  y[suction_at_] = delivery;
  y[n_] = suction;
  if (accumulator_) y[accumulator_at_] = suction;
  if (pipe_)
    pipe_->uniform(fluid_.state(suction).pressure, -pipe_->inflow(y + pipe_at_), y + pipe_at_);
}

std::vector<double> Network::at_rest(const std::vector<double>& chambers, double delivery) const {
  std::vector<double> y = uniform(delivery, delivery, 0);
  std::copy(chambers.begin(), chambers.end(), y.begin());
  for (int k = 0; k < n_ && air_at_ > 0; ++k)
    y[air_at_ + k] = fluid_.equilibrium(chambers[k]).value;
  return y;
}

double Network::load_gauge(const double* y) const {
  if (fixed_end_) return end_.gauge;
  return pipe_ ? pipe_->end_pressure(y + pipe_at_) - fluid_.atmosphere() : delivery_gauge(y);
}

Load::Flow Network::to_load(const double* y, const Fluid::State& line, const Fluid::State& source,
                            double load_size) const {
  const Fluid::State& outside = loop_ ? source : outside_;
  if (!pipe_) return load_.flow(line, outside, load_size);
  const double* modes = y + pipe_at_;
  if (!fixed_end_) return load_.flow(pipe_->end_side(modes), outside, load_size);
  Load::Flow flow;
  flow.value = pipe_->outflow(modes);
  return flow;
}

Fluid::State Network::source_of(const double* y) const {
  return has_suction_volume() ? fluid_.state(y[suction_at_]) : tank_.state;
}

MassFlow Network::charge_into(const Fluid::State& side) const {
  if (!loop_ || side.pressure >= tank_.state.pressure) return {};
  const double share = (tank_.state.pressure - side.pressure) / charge_opening_;
  MassFlow flow = orifice_.flow(charge_area_ * std::min(share, 1.0), tank_.state, side);
  if (share < 1) flow.by_second -= flow.value / share * side.pressure / charge_opening_;
  return flow;
}

Network::Sources Network::sources(const double* y) const {
  if (air_at_ == 0) return {};
  return {fluid_.equilibrium(has_suction_volume() ? y[suction_at_] : tank_.s),
          fluid_.equilibrium(fixed_ ? end_.s : y[n_]), fluid_.equilibrium(case_s_)};
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
                                   double volume, const ChamberFlows& flows, const Sources& from,
                                   double seconds) const {
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
    *one *= seconds;
  return rate;
}

bool Network::rates(const Moment& now, const double* y, double load_size, double* dy) const {
  const Fluid::State line = fixed_ ? end_.state : fluid_.state(y[n_]);
  const Fluid::State source = source_of(y);
  const Sources from = sources(y);
  double delivered = 0, taken = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = chamber_deg(now.block_deg, k);
    const Chamber::Volume volume = this->volume(now, k);
    const Fluid::Mixture at = mixture(y, k);
    const ChamberFlows flows = chamber_flows(angle, volume.value, at, source, line);
    const double mass = flows.in.value - flows.out.value - flows.lost.value;
    delivered += flows.out.value;
    taken += flows.in.value;
    dy[k] = at.stiffness * (now.seconds * mass / at.density - now.turning * volume.slope) /
            volume.value;
    if (air_at_ > 0) {
      dy[air_at_ + k] =
          air_rate(y[k], y[air_at_ + k], at, volume.value, flows, from, now.seconds).value;
      dy[k] += at.stiffness * at.swelling * dy[air_at_ + k];
    }
    if (!std::isfinite(dy[k])) return false;
  }
  if (suction_line_) {
    const double flow = y[suction_at_ + 1] * ideal_mass_flow();
    dy[suction_at_] =
        source.stiffness * now.seconds * (flow - taken) / (source.density * suction_volume_);
    dy[suction_at_ + 1] =
        now.seconds * suction_line_->rate(source.pressure, flow) / ideal_mass_flow();
  }
  if (fixed_) return finite(dy + n_, dy + size());
  const double load = to_load(y, line, source, load_size).value;
  double leaves = pipe_ ? pipe_->inflow(y + pipe_at_) : load;
  if (loop_) {
    dy[suction_at_] = source.stiffness * now.seconds * (load + charge_into(source).value - taken) /
                      (source.density * suction_volume_);
    leaves -= charge_into(line).value;
  }
  if (accumulator_) {
    const Fluid::State gas = fluid_.state(y[accumulator_at_]);
    const Accumulator::Oil oil = accumulator_->oil(y[accumulator_at_]);
    const double in = orifice_.flow(inlet_area_, line, gas).value;
    dy[accumulator_at_] =
        now.seconds * in / (gas.density * (oil.volume / gas.stiffness + oil.first));
    leaves += in;
  }
  dy[n_] = line.stiffness * now.seconds * (delivered - leaves) / (line.density * delivery_volume_);
  if (use_ == Use::period)
    dy[size() - 1] = (line.pressure - outside_.pressure) / (mean_scale_ * period_deg());
  if (pipe_) {
    double* modes = dy + pipe_at_;
    pipe_->rates(y + pipe_at_, line.pressure, fixed_end_ ? end_.state.pressure : load, modes);
    for (int i = 0; i < pipe_->size(); ++i) modes[i] *= now.seconds;
  }
  return finite(dy + n_, dy + size());
}

void Network::jacobian(const Moment& now, const double* y, double load_size, double* by_state,
                       double* by_load) const {
  const int size = this->size();
  std::fill(by_state, by_state + size * size, 0.0);
  if (by_load != nullptr) std::fill(by_load, by_load + size, 0.0);
  const auto entry = [&](int row, int column) -> double& { return by_state[column * size + row]; };
  const Fluid::State line = fixed_ ? end_.state : fluid_.state(y[n_]);
  const Fluid::State source = source_of(y);
  const double line_factor = line.stiffness * now.seconds / (line.density * delivery_volume_);
  const double source_factor =
      has_suction_volume() ? source.stiffness * now.seconds / (source.density * suction_volume_)
                           : 0;
  const Sources from = sources(y);
  double delivered = 0, taken = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = chamber_deg(now.block_deg, k);
    const Chamber::Volume volume = this->volume(now, k);
    const Fluid::Mixture at = mixture(y, k);
    const ChamberFlows flows = chamber_flows(angle, volume.value, at, source, line);
    const auto& [in, out, lost, in_by_air, out_by_air, lost_by_air] = flows;
    const double mass = in.value - out.value - lost.value;
    const double by_own = in.by_second - out.by_first - lost.by_first;
    delivered += out.value;
    taken += in.value;
    entry(k, k) = (at.d_stiffness * (now.seconds * mass / at.density - now.turning * volume.slope) +
                   at.stiffness * now.seconds * (by_own - mass / at.stiffness) / at.density) /
                  volume.value;
    const double by_mass = at.stiffness * now.seconds;
    if (has_suction_volume()) {
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
    const AirRate air = air_rate(y[k], y[a], at, volume.value, flows, from, now.seconds);
    entry(a, k) = air.by_pressure;
    entry(a, a) = air.by_air;
    // ds/dx is stiffness x (drive + swelling x d(air out)/dx).
    const double drive =
        (now.seconds * mass / at.density - now.turning * volume.slope) / volume.value;
    const double swells = at.stiffness * at.swelling;
    entry(k, k) += (at.d_stiffness * at.swelling + at.stiffness * at.d_swelling) * air.value +
                   swells * air.by_pressure;
    entry(k, a) = at.stiffness_by_air * (drive + at.swelling * air.value) +
                  by_mass * (in_by_air - out_by_air - lost_by_air + mass * at.swelling) /
                      (at.density * volume.value) +
                  at.stiffness * at.swelling_by_air * air.value + swells * air.by_air;
    if (has_suction_volume()) {
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
    entry(m, s) = now.seconds * suction_line_->by_port() * source.pressure / ideal_mass_flow();
    entry(m, m) = now.seconds * suction_line_->by_flow(flow);
  }
  if (fixed_) return;
  if (use_ == Use::period) entry(size - 1, n_) = line.pressure / (mean_scale_ * period_deg());
  // What is given at the far end of a pipe follows from the pressure there, which is that of every
  // mode.
  const Load::Flow load = fixed_end_ ? Load::Flow() : to_load(y, line, source, load_size);
  double leaves = pipe_ ? pipe_->inflow(y + pipe_at_) : load.value;
  if (loop_) {
    const int s = suction_at_;
    const MassFlow low = charge_into(source), high = charge_into(line);
    entry(s, s) += source_factor *
                   (load.by_outside + low.by_second +
                    (load.value + low.value - taken) * (source.d_stiffness - 1) / source.stiffness);
    entry(n_, n_) += line_factor * high.by_second;
    leaves -= high.value;
    if (by_load != nullptr) by_load[s] = source_factor * load.by_size;
    if (pipe_) {
      for (int j = 0; j < pipe_->pressures(); ++j)
        entry(s, pipe_at_ + j) = source_factor * load.by_side;
      for (int i = 0; i < pipe_->size(); ++i)
        entry(pipe_at_ + i, s) = now.seconds * pipe_->by_end(i) * load.by_outside;
    } else {
      entry(s, n_) += source_factor * load.by_side;
      entry(n_, s) = -line_factor * load.by_outside;
    }
  }
  if (accumulator_) {
    const int a = accumulator_at_;
    const Fluid::State gas = fluid_.state(y[a]);
    const Accumulator::Oil oil = accumulator_->oil(y[a]);
    const MassFlow in = orifice_.flow(inlet_area_, line, gas);
    const double soft = oil.volume / gas.stiffness + oil.first;
    const double hardens =
        (oil.first - oil.volume * gas.d_stiffness / gas.stiffness) / gas.stiffness + oil.second;
    const double factor = now.seconds / (gas.density * soft);
    entry(a, n_) = factor * in.by_first;
    entry(a, a) = factor * (in.by_second - in.value * (1 / gas.stiffness + hardens / soft));
    entry(n_, n_) -= line_factor * in.by_first;
    entry(n_, a) = -line_factor * in.by_second;
    leaves += in.value;
  }
  entry(n_, n_) += line_factor * ((pipe_ ? 0 : -load.by_side) +
                                  (delivered - leaves) * (line.d_stiffness - 1) / line.stiffness);
  if (!pipe_) {
    if (by_load != nullptr) by_load[n_] = -line_factor * load.by_size;
    return;
  }
  for (int i = 0; i < pipe_->size(); ++i) {
    const int row = pipe_at_ + i;
    for (int j = 0; j < pipe_->size(); ++j)
      entry(row, pipe_at_ + j) =
          now.seconds *
          (pipe_->by_state(i, j) + (j < pipe_->pressures() ? pipe_->by_end(i) * load.by_side : 0));
    entry(row, n_) = now.seconds * pipe_->by_start(i) * line.pressure;
    if (by_load != nullptr) by_load[row] = now.seconds * pipe_->by_end(i) * load.by_size;
  }
  for (int j = pipe_->pressures(); j < pipe_->size(); ++j)
    entry(n_, pipe_at_ + j) = -line_factor * pipe_->inflow_by(j - pipe_->pressures());
}

void Network::flows(const Moment& now, const double* y, double load_size, Flows& flows) const {
  flows.suction.resize(n_);
  flows.delivery.resize(n_);
  flows.leakage.resize(n_);
  const Fluid::State line = fixed_ ? end_.state : fluid_.state(y[n_]);
  const Fluid::State source = source_of(y);
  flows.load = 0;
  flows.taken = 0;
  flows.power = 0;
  for (int k = 0; k < n_; ++k) {
    const double angle = chamber_deg(now.block_deg, k);
    const Chamber::Volume volume = this->volume(now, k);
    const Fluid::State at = mixture(y, k);
    flows.delivery[k] = orifice_.flow(delivery_.area(angle), at, line).value;
    flows.suction[k] = orifice_.flow(suction_.area(angle), source, at).value;
    flows.leakage[k] = leakage_.flow(at, volume.value).value;
    flows.load += flows.delivery[k];
    flows.taken += flows.suction[k];
    flows.power -= fluid_.gauge(y[k]) * volume.slope * now.turning / now.seconds;
  }
  flows.relief = flows.accumulator = 0;
  if (!fixed_) {
    const Load::Flow load = to_load(y, line, source, load_size);
    flows.load = load.value;
    flows.relief = load.relief;
  }
  if (suction_line_) flows.taken = y[suction_at_ + 1] * ideal_mass_flow();
  if (loop_) flows.taken = charge_into(source).value + charge_into(line).value;
  if (accumulator_)
    flows.accumulator = orifice_.flow(inlet_area_, line, fluid_.state(y[accumulator_at_])).value;
}

double Network::load_flow(double x, const double* y, double load_size) const {
  if (!fixed_) return to_load(y, fluid_.state(y[n_]), source_of(y), load_size).value;
  double sum = 0;
  for (int k = 0; k < n_; ++k)
    sum += orifice_.flow(delivery_.area(angle_deg(x, k)), fluid_.state(y[k]), end_.state).value;
  return sum;
}

PowerBudget Network::power(const Moment& now, const double* y, const Flows& flows) const {
  PowerBudget power;
  power[Place::pistons] = flows.power;
  const double line = fixed_ ? end_.potential : fluid_.potential(y[n_]);
  const double source = has_suction_volume() ? fluid_.potential(y[suction_at_]) : tank_.potential;
  const Sources from = sources(y);
  const double taken = flows.taken;
  for (int k = 0; k < n_; ++k) {
    const Fluid::Mixture at = mixture(y, k);
    const double volume = this->volume(now, k).value;
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
  }
  // In a line the oil has one density: its potential there is linear in the pressure.
  if (suction_line_) {
    const double drop = fluid_.state(y[suction_at_]).pressure - tank_.state.pressure;
    power[Place::suction_line] = suction_line_->lost(taken);
    power[Place::line_density] +=
        taken * (tank_.potential + drop / suction_state_.density - source);
  }
  power[Place::tank] = taken * tank_.potential;
  double front = line;  // of the load
  if (pipe_) {
    const double* modes = y + pipe_at_;
    const auto within = [&](double pressure) {
      return fixed_potential_ + (pressure - fixed_state_.pressure) / fixed_state_.density;
    };
    front = within(fixed_end_ ? end_.state.pressure : pipe_->end_pressure(modes));
    power[Place::delivery_line] = pipe_->friction_power(modes);
    power[Place::damped_waves] = pipe_->damped_power(modes);
    power[Place::line_density] +=
        pipe_->inflow(modes) * (line - within(fluid_.state(y[n_]).pressure));
  }
  if (loop_) {
    front -= source;
    power[Place::charge_valves] = charge_into(source_of(y)).value * (tank_.potential - source) +
                                  charge_into(fluid_.state(y[n_])).value * (tank_.potential - line);
  }
  power[Place::load] = (flows.load - flows.relief) * front;
  power[Place::relief_valve] = flows.relief * front;
  if (accumulator_)
    power[Place::accumulator_inlet] =
        flows.accumulator * (line - fluid_.potential(y[accumulator_at_]));
  return power;
}

double Network::port_power(const double* y, const Flows& flows) const {
  const double line = fixed_ ? end_.potential : fluid_.potential(y[n_]);
  const double source = has_suction_volume() ? fluid_.potential(y[suction_at_]) : tank_.potential;
  // With a volume at a port it is what leaves or enters that volume: smoother than the flows of the
  // chambers, and the same over a period, after which the volume holds as much as before it.
  double out = flows.load;
  if (!fixed_) {
    if (pipe_) out = pipe_->inflow(y + pipe_at_);
    out += flows.accumulator;
    if (loop_) out -= charge_into(fluid_.state(y[n_])).value;
  }
  double in = flows.taken;  // in a line, or through the ports from a reservoir
  if (loop_) in = flows.load + charge_into(fluid_.state(y[suction_at_])).value;
  return out * line - in * source;
}

Network::Stored Network::stored(const Moment& now, const double* y) const {
  Stored all;
  const auto add = [&](double volume, double density, double potential, double s) {
    all.mass += volume * density;
    all.energy += volume * (density * potential - fluid_.gauge(s));
  };
  for (int k = 0; k < n_; ++k)
    add(volume(now, k).value, mixture(y, k).density,
        air_at_ > 0 ? fluid_.potential(y[k], y[air_at_ + k]) : fluid_.potential(y[k]), y[k]);
  const auto add_volume = [&](double volume, double s) {
    add(volume, fluid_.state(s).density, fluid_.potential(s), s);
  };
  if (!fixed_) add_volume(delivery_volume_, y[n_]);
  if (accumulator_) {
    const double a = y[accumulator_at_];
    add_volume(accumulator_->oil(a).volume, a);
    all.energy += accumulator_->energy(a);
  }
  if (has_suction_volume()) add_volume(suction_volume_, y[suction_at_]);
  if (suction_line_) {
    all.energy += suction_line_->kinetic_energy(y[suction_at_ + 1] * ideal_mass_flow());
  }
  if (pipe_) {
    const double mass = pipe_->mass(y + pipe_at_);
    all.mass += mass;
    all.energy += mass * fixed_potential_ + pipe_->energy(y + pipe_at_);
  }
  return all;
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
  if (load_.has_relief() && !fixed_end_) all.push_back(Place::relief_valve);
  if (accumulator_) all.push_back(Place::accumulator_inlet);
  if (loop_) all.push_back(Place::charge_valves);
  return all;
}

int Network::place_count() const {
  const auto last = [](Place place) { return static_cast<int>(place) + 1; };
  return std::max(last(Place::line_density), last(places().back()));
}

}  // namespace bentaxis::hydraulics

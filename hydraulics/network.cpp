#include "network.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/pump/delivery_side.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "elements.h"
#include "viscosity.h"

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
  if (speed == 0) refuse("at rest there is no periodic pressure");
  if (speed < 0 && !delivery_is_held(the_case) && !load_of(the_case).sets_pressure())
    refuse(
        "in reverse rotation the pump takes oil from the delivery line (motoring), and no size of "
        "a load results in delivery_bar: give a supply ([load] kind = \"constant_pressure\") or "
        "the size of [load], for example in a [loop]");
  return 1 / (6 * std::abs(speed));
}

double kinematic_viscosity(const HydraulicData& data) {
  return data.oil ? Viscosity(*data.oil, data.density).kinematic() : 0;
}

}  // namespace

template <class E, class... Arguments>
E* Network::add(Arguments&&... arguments) {
  auto element = std::make_unique<E>(std::forward<Arguments>(arguments)...);
  E* const added = element.get();
  added->begin_at(states_);
  states_ += added->states();
  elements_.push_back(std::move(element));
  return added;
}

Network::Network(const Case& the_case, Use use)
    : direction_(validate(the_case).operation.speed_rpm < 0 && use == Use::period ? -1 : 1),
      fixed_end_(delivery_is_held(the_case)),
      fluid_(data_of(the_case)),
      seconds_per_degree_(hydraulics::seconds_per_degree(the_case, use)),
      orifice_{the_case.hydraulics->discharge_coefficient,
               the_case.hydraulics->transition_pressure * the_case.hydraulics->transition_pressure},
      suction_(fluid_, the_case.pressure.ports.suction),
      delivery_(fluid_, the_case.pressure.ports.delivery),
      outside_(fluid_, 0),
      tank_(suction_),
      end_(delivery_),
      mean_scale_(delivery_.gauge > 0 ? delivery_.gauge : fluid_.atmosphere()),
      load_(load_of(the_case), orifice_, fluid_, suction_.oil.density * load_of(the_case).flow,
            the_case.hydraulics->loop.has_value()),
      loop_(the_case.hydraulics->loop.has_value()),
      fixed_(fixed_end_ && !the_case.hydraulics->delivery_line),
      sought_(!fixed_end_ && load_.sought()) {
  chambers_ = add<Chambers>(the_case, fluid_, orifice_);
  const Geometry& g = the_case.pump.geometry;
  const double area = kPi / 4 * g.bore_diameter * g.bore_diameter;
  if (chamber().swept() <= kNoStroke * area * g.piston_length)
    throw InputError(the_case.file.string() +
                     ": [pump] tilt_deg = " + number_text(g.tilt / kRadPerDegree) +
                     ": the pistons have no stroke, so the displacement is 0 and no hydraulic "
                     "pressure can be computed");
  const HydraulicData& data = *the_case.hydraulics;
  if (use == Use::period && load_.kind() == LoadKind::flow && !fixed_end_ && !backwards() &&
      !(data.load->flow > 0 && data.load->flow * suction_.oil.density < ideal_mass_flow()))
    throw InputError(the_case.file.string() +
                     ": [load] flow_l_per_min = " + number_text(data.load->flow / kLitrePerMinute) +
                     ": must be above 0 and below the ideal flow of the pump, " +
                     number_text(ideal_mass_flow() / suction_.oil.density / kLitrePerMinute) +
                     " l/min");
  // The terminals between which the load lies.
  const Terminal front = data.delivery_line ? kFarEnd : kDelivery;
  const Terminal behind = loop_ ? kSuction : kOutside;
  if (!fixed_) add<PortVolume>(kDelivery, data.delivery_volume);
  if (data.suction_line) {
    suction_at_ = add<PortVolume>(kSuction, data.suction_line->volume)->at();
    add<SuctionPipe>(SuctionLine(*data.suction_line, suction_.oil, kinematic_viscosity(data)),
                     ideal_mass_flow());
  }
  if (loop_) suction_at_ = add<PortVolume>(kSuction, data.loop->volume)->at();
  if (data.delivery_line) {
    using End = TransmissionLine::End;
    const TransmissionLine line(*data.delivery_line,
                                fixed_end_ ? End::given_pressure : End::given_flow, delivery_.oil,
                                kinematic_viscosity(data));
    if (line.size() > kMaxModes)
      throw InputError(the_case.file.string() + ": [delivery_line] bandwidth_Hz = " +
                       number_text(data.delivery_line->bandwidth) + ": takes " +
                       std::to_string(line.size()) + " modes, more than " +
                       std::to_string(kMaxModes) + ": lower it, or length_m");
    pipe_ = add<DeliveryPipe>(line, delivery_, fixed_end_ ? &end_ : nullptr);
  }
  if (fixed_end_)
    add<HeldEnd>(front);
  else
    add<LoadBranch>(load_, front, behind);
  if (loop_) add<ChargeSupply>(orifice_, data.loop->charge_area, data.loop->opening);
  if (data.accumulator)
    accumulator_at_ = add<AccumulatorBranch>(Accumulator(*data.accumulator, fluid_), orifice_,
                                             data.accumulator->inlet_area)
                          ->at();
  states_ += chambers_->begin_air_at(states_);
  const int states = states_;
  if (!fixed_ && use == Use::period) add<MeanDelivery>(mean_scale_, period_deg());
  size_ = std::exchange(states_, states);
  // All chambers meet an edge at the same angle within the period.
  for (const auto* port : {&delivery(), &suction()})
    for (const double edge : port->edges_deg()) {
      const double turned = std::fmod(edge, period_deg());
      const double within = backwards() ? period_deg() - turned : turned;
      if (within > kSameEdge && within < period_deg() - kSameEdge) edges_deg_.push_back(within);
    }
  sort_once(edges_deg_, kSameEdge);
}

Network::~Network() = default;

void Network::set_suction(std::optional<double> gauge) {
  const double now = gauge.value_or(suction_.gauge);
  if (now != tank_.gauge) tank_ = Held(fluid_, now);
}

void Network::set_delivery(std::optional<double> gauge) {
  const double now = gauge.value_or(delivery_.gauge);
  if (now != end_.gauge) end_ = Held(fluid_, now);
}

Moment Network::at(double x) const {
  return {direction_ * x, seconds_per_degree_, direction_ * kRadPerDegree, {}, {}, true};
}

Moment Network::at(const AxisMotion& shaft, const AxisMotion& block) {
  return {block.angle / kRadPerDegree, 1, 1, shaft, block, false};
}

double Network::ideal_mass_flow() const {
  return suction_.oil.density * displacement() / (360 * seconds_per_degree_);
}

double Network::load_size_for(double mass_flow) const {
  return load_.sought()
             ? load_.size_for(mass_flow, delivery_.oil, loop_ ? suction_.oil : outside_.oil)
             : load_.size();
}

std::vector<double> Network::uniform(double chambers, double delivery, double mass_flow) const {
  std::vector<double> y(states_);
  start({chambers, suction_.s, delivery, fluid_.state(delivery).pressure, mass_flow}, y.data());
  chambers_->start_air(fluid_, y.data());
  return y;
}

double Network::expected_log_pressure(double share) const {
  if (!loop_ || load_.sought()) return delivery_.s;
  constexpr int kHalvings = 50;
  const auto takes_it = [&](double s) {
    const double flow = load_.flow(fluid_.state(s), suction_.oil, load_.size()).value;
    return !(flow < share * ideal_mass_flow());
  };
  return numerics::bisect({suction_.s, fluid_.log_pressure(kHighestPressure)}, kHalvings, takes_it)
      .middle();
}

std::vector<OilColumn> Network::state_columns() const {
  std::vector<OilColumn> all(static_cast<std::size_t>(states_));
  for (const auto& element : elements_) element->name_states(all.data());
  return all;
}

std::vector<int> Network::order_after_period() const {
  std::vector<int> order(static_cast<std::size_t>(states_));
  std::iota(order.begin(), order.end(), 0);
  for (int k = 0; k < pistons(); ++k) {
    order[next_of(k)] = k;
    if (air_at() > 0) order[air_at() + next_of(k)] = air_at() + k;
  }
  return order;
}

void Network::exchange_sides(double* y) const {
  const double suction = y[suction_at_], delivery = y[pistons()];
  std::vector<double> chambers(y, y + pistons());
  for (double& s : chambers) s = s == suction ? delivery : suction;
  start({suction, delivery, suction, fluid_.state(suction).pressure, -ideal_mass_flow()}, y);
  std::copy(chambers.begin(), chambers.end(), y);
}

std::vector<double> Network::at_rest(const std::vector<double>& chambers, double delivery) const {
  std::vector<double> y = uniform(delivery, delivery, 0);
  std::copy(chambers.begin(), chambers.end(), y.begin());
  chambers_->start_air(fluid_, y.data());
  return y;
}

double Network::load_gauge(const double* y) const {
  if (fixed_end_) return end_.gauge;
  return pipe_ != nullptr ? pipe_->end_pressure(y) - fluid_.atmosphere() : delivery_gauge(y);
}

void Network::start(const StartOf& start, double* y) const {
  for (const auto& element : elements_) element->start(start, y);
}

bool Network::rates(const Moment& now, const double* y, double load_size, double* dy) const {
  System sys(fluid_, now, y, load_size);
  sys.rates = dy;
  stamp(sys);
  for (const auto& element : elements_) element->finish(sys);
  return std::all_of(dy, dy + size_, [](double x) { return std::isfinite(x); });
}

void Network::jacobian(const Moment& now, const double* y, double load_size, double* by_state,
                       double* by_load) const {
  std::fill(by_state, by_state + size_ * size_, 0.0);
  if (by_load != nullptr) std::fill(by_load, by_load + size_, 0.0);
  System sys(fluid_, now, y, load_size);
  sys.want(by_state, by_load, size_);
  stamp(sys);
  for (const auto& element : elements_) element->finish(sys);
}

void Network::connect(System& sys) const {
  sys.hold(kTank, tank_);
  sys.hold(kOutside, outside_);
  if (!has_suction_volume()) sys.hold(kSuction, tank_);
  if (fixed_) sys.hold(kDelivery, end_);
  for (const auto& element : elements_) element->connect(sys);
}

void Network::stamp(System& sys) const {
  connect(sys);
  for (const auto& element : elements_) element->stamp(sys);
}

void Network::flows(const Moment& now, const double* y, double load_size, Flows& flows) const {
  flows.relief = flows.accumulator = 0;
  System sys(fluid_, now, y, load_size);
  sys.flows = &flows;
  stamp(sys);
  // With a volume at a port it is what leaves or enters that volume: smoother than the flows of the
  // chambers, and the same over a period, after which the volume holds as much as before it.
  const System::Node &in = sys[kSuction], &out = sys[kDelivery];
  flows.carried_in = in.is_state() ? -in.leaves : -in.arrives;
  flows.carried_out = out.is_state() ? out.leaves : out.arrives;
}

double Network::load_flow(double x, const double* y, double load_size) const {
  const Moment now = at(x);
  Flows flows;
  System sys(fluid_, now, y, load_size);
  sys.flows = &flows;
  connect(sys);
  // What the chambers bring passes no load at once but where the port is held.
  for (const auto& element : elements_)
    if (fixed_ || element.get() != chambers_) element->stamp(sys);
  return flows.load;
}

PowerBudget Network::power(const Moment& now, const double* y, const Flows& flows) const {
  PowerBudget power;
  System sys(fluid_, now, y, 0);
  connect(sys);
  power[Place::tank] = flows.taken * tank_.potential;
  for (const auto& element : elements_) element->power(sys, flows, power);
  return power;
}

double Network::port_power(const double* y, const Flows& flows) const {
  const double line = fixed_ ? end_.potential : fluid_.potential(y[pistons()]);
  const double source = has_suction_volume() ? fluid_.potential(y[suction_at_]) : tank_.potential;
  return flows.carried_out * line - flows.carried_in * source;
}

Stored Network::stored(const Moment& now, const double* y) const {
  Stored all;
  System sys(fluid_, now, y, 0);
  connect(sys);
  for (const auto& element : elements_) element->stored(sys, all);
  return all;
}

std::vector<Place> Network::places() const {
  std::vector<Place> all = {Place::tank, Place::load};
  for (const auto& element : elements_) element->places(all);
  sort_once(all);
  return all;
}

int Network::place_count() const {
  const auto last = [](Place place) { return static_cast<int>(place) + 1; };
  return std::max(last(Place::line_density), last(places().back()));
}

}  // namespace bentaxis::hydraulics

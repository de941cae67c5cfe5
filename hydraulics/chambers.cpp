#include "chambers.h"

#include <algorithm>

#include "bentaxis/pump/units.h"

namespace bentaxis::hydraulics {

namespace {

Orifice orifice_of(const PlatePort& port, Orifice common) {
  common.discharge = port.discharge_coefficient.value_or(common.discharge);
  return common;
}

}  // namespace

Chambers::Chambers(const Case& the_case, const Fluid& fluid, const Orifice& orifice)
    : Element(the_case.pump.geometry.pistons),
      chamber_(the_case.pump.geometry, the_case.hydraulics->dead_volume,
               the_case.hydraulics->stroke),
      delivery_(*the_case.hydraulics, the_case.hydraulics->delivery,
                the_case.pump.geometry.bore_circle_radius),
      suction_(*the_case.hydraulics, the_case.hydraulics->suction,
               the_case.pump.geometry.bore_circle_radius),
      into_delivery_(orifice_of(the_case.hydraulics->delivery, orifice)),
      from_suction_(orifice_of(the_case.hydraulics->suction, orifice)),
      leakage_(the_case, fluid, chamber_),
      air_takes_time_(the_case.hydraulics->cavitation == Cavitation::rate &&
                      the_case.hydraulics->dissolved_air > 0),
      release_time_(the_case.hydraulics->release_time),
      dissolution_time_(the_case.hydraulics->dissolution_time),
      case_(fluid, the_case.hydraulics->case_pressure) {}

void Chambers::start(const StartOf& start, double* y) const {
  std::fill(y, y + count(), start.chambers);
}

void Chambers::start_air(const Fluid& fluid, double* y) const {
  for (int k = 0; k < count() && air_at_ > 0; ++k) y[air_at_ + k] = fluid.equilibrium(y[k]).value;
}

void Chambers::name_states(OilColumn* all) const {
  for (int k = 0; k < count(); ++k) {
    const std::string number = std::to_string(k + 1);
    all[k] = {"ln_p_" + number, "ln(P/P0) in chamber " + number + ", P absolute, P0 atmospheric"};
    if (air_at_ > 0)
      all[air_at_ + k] = {"air_out_" + number,
                          "share of the dissolved air that is out in chamber " + number};
  }
}

Chamber::Volume Chambers::volume(const Moment& now, int k) const {
  if (now.locked) return chamber_.volume(radians(angle_deg(now.block_deg, k)));
  const double behind = 2 * kPi * k / count();
  const Chamber::Turned turned =
      chamber_.volume(now.shaft.angle - behind, now.block.angle - behind);
  return {turned.value, turned.by_joint * now.shaft.speed + turned.by_bore * now.block.speed};
}

Chambers::Sources Chambers::sources(System& sys) const {
  if (air_at_ == 0) return {};
  return {sys.fluid.equilibrium(sys[kSuction].s), sys.fluid.equilibrium(sys[kDelivery].s),
          sys.fluid.equilibrium(case_.s)};
}

Chambers::Exchange Chambers::exchange(System& sys, double angle_deg, double volume,
                                      const Fluid::Mixture& at) const {
  const Side &source = sys[kSuction].side, &line = sys[kDelivery].side;
  if (sys.by_state == nullptr)
    return {{from_suction_.value(suction_.area(angle_deg), source, at), 0, 0},
            {into_delivery_.value(delivery_.area(angle_deg), at, line), 0, 0},
            {leakage_.value(at, volume), 0, 0}};
  Exchange flows{from_suction_.flow(suction_.area(angle_deg), source, at),
                 into_delivery_.flow(delivery_.area(angle_deg), at, line),
                 leakage_.flow(at, volume)};
  if (at.swelling != 0) {
    // All depend on the sum of both densities, by its root or in proportion.
    const double thinner = -at.density * at.swelling;
    flows.in_by_air = flows.in.value * thinner / (2 * (at.density + source.density));
    flows.out_by_air = flows.out.value * thinner / (2 * (at.density + line.density));
    flows.lost_by_air = flows.lost.value * thinner / (at.density + case_.oil.density);
  }
  return flows;
}

Chambers::AirRate Chambers::release(const Fluid& fluid, double s, double air_out) const {
  const Fluid::AirOut wanted = fluid.equilibrium(s);
  const double time = air_out < wanted.value ? release_time_ : dissolution_time_;
  return {(wanted.value - air_out) / time, wanted.slope / time, -1 / time};
}

Chambers::AirRate Chambers::air_rate(System& sys, int k, const Fluid::Mixture& at, double volume,
                                     const Exchange& flows, const Sources& from) const {
  const double air_out = sys.y[air_at_ + k], per_mass = 1 / (at.density * volume);
  AirRate rate = release(sys.fluid, sys.y[k], air_out);
  double brought = 0, by_air = 0, by_pressure = 0;
  // Oil that comes in brings its own air: `sign` x flow > 0.
  const auto bring = [&](const MassFlow& flow, double sign, double by_own, double flow_by_air,
                         double by_source, const Fluid::AirOut& source) {
    const double in = sign * flow.value;
    if (!(in > 0)) return 0.0;
    const double more = source.value - air_out;
    brought += in * more;
    by_pressure += sign * by_own * more;
    by_air += sign * flow_by_air * more - in;
    return per_mass * (sign * by_source * more + in * source.slope);
  };
  const auto& [in, out, lost, in_by_air, out_by_air, lost_by_air] = flows;
  rate.by_suction = bring(in, 1, in.by_second, in_by_air, in.by_first, from.suction);
  rate.by_delivery = bring(out, -1, out.by_first, out_by_air, out.by_second, from.delivery);
  bring(lost, -1, lost.by_first, lost_by_air, 0, from.outside);
  rate.value += per_mass * brought;
  rate.by_pressure += per_mass * (by_pressure - brought / at.stiffness);
  rate.by_air += per_mass * (by_air + brought * at.swelling);
  for (double* one :
       {&rate.value, &rate.by_pressure, &rate.by_air, &rate.by_suction, &rate.by_delivery})
    *one *= sys.now.seconds;
  return rate;
}

void Chambers::stamp(System& sys) const {
  const Moment& now = sys.now;
  System::Node &source = sys[kSuction], &line = sys[kDelivery];
  const Sources from = sources(sys);
  if (sys.flows != nullptr) {
    for (auto* flows : {&sys.flows->suction, &sys.flows->delivery, &sys.flows->leakage})
      flows->resize(count());
    sys.flows->oil.resize(count());
    sys.flows->volume.resize(count());
    sys.flows->power = 0;
  }
  double delivered = 0, taken = 0;
  for (int k = 0; k < count(); ++k) {
    const Chamber::Volume volume = this->volume(now, k);
    const Fluid::Mixture at = mixture(sys.fluid, sys.y, k);
    const Exchange flows = exchange(sys, angle_deg(now.block_deg, k), volume.value, at);
    const auto& [in, out, lost, in_by_air, out_by_air, lost_by_air] = flows;
    const double mass = in.value - out.value - lost.value;
    delivered += out.value;
    taken += in.value;
    if (sys.flows != nullptr) {
      sys.flows->suction[k] = in.value;
      sys.flows->delivery[k] = out.value;
      sys.flows->leakage[k] = lost.value;
      sys.flows->oil[k] = at;
      sys.flows->volume[k] = volume.value;
      sys.flows->power -= sys.fluid.gauge(sys.y[k]) * volume.slope * now.turning / now.seconds;
    }
    if (sys.rates == nullptr && sys.by_state == nullptr) continue;
    const double drive = now.seconds * mass / at.density - now.turning * volume.slope;
    // What has too little oil comes to rest at the lowest pressure, where the law has one.
    const Fluid::Expanding left = drive < 0 ? sys.fluid.expanding(sys.y[k]) : Fluid::Expanding();
    const double stiffness = at.stiffness * left.value;
    const double swells = at.stiffness * at.swelling;
    const AirRate air = air_at_ > 0 ? air_rate(sys, k, at, volume.value, flows, from) : AirRate();
    if (sys.rates != nullptr) {
      sys.rates[k] = stiffness * drive / volume.value;
      if (air_at_ > 0) {
        sys.rates[air_at_ + k] = air.value;
        sys.rates[k] += swells * air.value;
      }
    }
    if (sys.by_state == nullptr) continue;
    const double by_mass = stiffness * now.seconds;
    const double d_stiffness = at.d_stiffness * left.value + at.stiffness * left.slope;
    const double by_own = in.by_second - out.by_first - lost.by_first;
    sys.entry(k, k) =
        (d_stiffness * drive + by_mass * (by_own - mass / at.density_stiffness) / at.density) /
        volume.value;
    // A port and its column, the flow from there by both sides and by the air, and the air's rate.
    const auto exchange_with = [&](System::Node& port, double by_port, double by_chamber,
                                   double by_air, double air_by_port) {
      if (!port.is_state()) return;
      sys.entry(k, port.at) = by_mass * by_port / (at.density * volume.value);
      sys.entry(port.at, k) = -port.per_mass * by_chamber;
      sys.entry(port.at, port.at) -= port.per_mass * by_port;
      if (air_at_ == 0) return;
      sys.entry(air_at_ + k, port.at) = air_by_port;
      sys.entry(k, port.at) += swells * air_by_port;
      sys.entry(port.at, air_at_ + k) = -port.per_mass * by_air;
    };
    exchange_with(source, in.by_first, in.by_second, in_by_air, air.by_suction);
    exchange_with(line, -out.by_second, -out.by_first, -out_by_air, air.by_delivery);
    if (air_at_ == 0) continue;
    const int a = air_at_ + k;
    sys.entry(a, k) = air.by_pressure;
    sys.entry(a, a) = air.by_air;
    // ds/dx is stiffness x (drive/volume + swelling x d(air out)/dx).
    sys.entry(k, k) += (at.d_stiffness * at.swelling + at.stiffness * at.d_swelling) * air.value +
                       swells * air.by_pressure;
    sys.entry(k, a) = at.stiffness_by_air * (drive / volume.value + at.swelling * air.value) +
                      by_mass * (in_by_air - out_by_air - lost_by_air + mass * at.swelling) /
                          (at.density * volume.value) +
                      at.stiffness * at.swelling_by_air * air.value + swells * air.by_air;
  }
  line.arrives = delivered;
  source.arrives = -taken;
  if (sys.flows != nullptr) sys.flows->taken = taken;
}

void Chambers::power(System& sys, const Flows& flows, PowerBudget& power) const {
  power[Place::pistons] = flows.power;
  const double line = sys.potential(kDelivery), source = sys.potential(kSuction);
  const Sources from = sources(sys);
  const double* y = sys.y;
  for (int k = 0; k < count(); ++k) {
    const Fluid::Mixture& at = flows.oil[k];
    const double volume = flows.volume[k];
    const double in = flows.suction[k], out = flows.delivery[k], lost = flows.leakage[k];
    // What comes in brings the air that is out where it comes from.
    const double air = air_at_ > 0 ? y[air_at_ + k] : 0;
    const double by_air = air_at_ > 0 ? sys.fluid.potential_by_air(y[k]) : 0;
    const double own = air_at_ > 0 ? sys.fluid.potential(y[k], air) : sys.fluid.potential(y[k], at);
    const auto potential = [&](bool comes_in, const Fluid::AirOut& there) {
      return comes_in ? own + by_air * (there.value - air) : own;
    };
    power[in < 0 ? Place::suction_backflow : Place::suction_port] +=
        in * (source - potential(in > 0, from.suction));
    power[out < 0 ? Place::delivery_backflow : Place::delivery_port] +=
        out * (potential(out < 0, from.delivery) - line);
    if (air_at_ > 0)
      power[Place::air] -= at.density * volume * by_air * release(sys.fluid, y[k], air).value;
    const Leakage::Parts parts = leakage_.parts(at, volume);
    const double drop = potential(lost < 0, from.outside) - case_.potential;
    power[Place::conductance] += parts.conductance * drop;
    power[Place::piston_gap] += parts.piston_gap * drop;
    power[Place::plate_gap] += parts.plate_gap * drop;
    power[Place::ring_slot] += parts.ring_slot * drop;
    power[Place::drain] += lost * case_.potential;
  }
}

void Chambers::stored(System& sys, Stored& all) const {
  const double* y = sys.y;
  for (int k = 0; k < count(); ++k)
    all.add(volume(sys.now, k).value, mixture(sys.fluid, y, k).density,
            air_at_ > 0 ? sys.fluid.potential(y[k], y[air_at_ + k]) : sys.fluid.potential(y[k]),
            sys.fluid.gauge(y[k]));
}

void Chambers::places(std::vector<Place>& all) const {
  all.insert(all.end(), {Place::pistons, Place::drain, Place::suction_port, Place::suction_backflow,
                         Place::delivery_port, Place::delivery_backflow});
  if (leakage_.has_conductance()) all.push_back(Place::conductance);
  if (leakage_.has_piston_gap()) all.push_back(Place::piston_gap);
  if (leakage_.has_plate_gap()) all.push_back(Place::plate_gap);
  if (leakage_.has_ring_slot()) all.push_back(Place::ring_slot);
  if (air_at_ > 0) all.push_back(Place::air);
}

}  // namespace bentaxis::hydraulics

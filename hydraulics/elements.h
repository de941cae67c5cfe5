// The elements beside the chambers: volumes, lines, loads, accumulator, charge supply.
#pragma once

#include <algorithm>

#include "accumulator.h"
#include "element.h"
#include "load.h"
#include "suction_line.h"
#include "transmission_line.h"

namespace bentaxis::hydraulics {

/// The volume of a port. State: s.
class PortVolume final : public Element {
 public:
  PortVolume(Terminal port, double volume) : Element(1), port_(port), volume_(volume) {}
  void start(const StartOf& start, double* y) const override {
    y[at()] = port_ == kSuction ? start.suction : start.delivery;
  }

  void name_states(OilColumn* all) const override {
    all[at()] = port_ == kSuction ? OilColumn{"ln_p_suction", "ln(P/P0) in the suction port"}
                                  : OilColumn{"ln_p_delivery", "ln(P/P0) in the delivery volume"};
  }

  void connect(System& sys) const override {
    sys.free(port_, at());
    System::Node& node = sys[port_];
    if (sys.by_state != nullptr)
      node.per_mass = node.stiffness * sys.now.seconds / (node.side.density * volume_);
  }

  void finish(System& sys) const override {
    const System::Node& node = sys[port_];
    const double stiffness = node.stiffness;
    const double mass = node.arrives - node.leaves;
    if (sys.rates != nullptr)
      sys.rates[at()] = stiffness * sys.now.seconds * mass / (node.side.density * volume_);
    if (sys.by_state == nullptr) return;
    sys.stamp_others(port_, at(), -node.per_mass);
    // The logarithmic derivative of K/P/density is (K/P)'/(K/P) - 1/(K/P), the last one of density.
    const double thinner = stiffness / node.side.stiffness;
    sys.entry(at(), at()) += node.per_mass * (mass * (node.d_stiffness - thinner) / stiffness -
                                              sys.leaves_by_own(port_));
  }

  void stored(System& sys, Stored& all) const override {
    const System::Node& node = sys[port_];
    all.add(volume_, node.side.density, sys.potential(port_), sys.fluid.gauge(node.s));
  }

 private:
  Terminal port_;
  double volume_;
};

/// From the tank to the suction port. State: its mass flow over `scale`, kg/s.
class SuctionPipe final : public Element {
 public:
  SuctionPipe(const SuctionLine& line, double scale) : Element(1), line_(line), scale_(scale) {}
  void start(const StartOf& start, double* y) const override { y[at()] = start.mass_flow / scale_; }

  void name_states(OilColumn* all) const override {
    all[at()] = {"flow_suction_line", "mass flow in the suction line over the ideal one"};
  }

  void stamp(System& sys) const override {
    const double flow = sys.y[at()] * scale_;
    const System::Node& port = sys[kSuction];
    sys.flow(kTank, kSuction, {flow, 0, 0});
    if (sys.flows != nullptr) sys.flows->taken = flow;
    if (sys.rates != nullptr)
      sys.rates[at()] =
          sys.now.seconds * line_.rate(sys[kTank].side.pressure, port.side.pressure, flow) / scale_;
    if (sys.by_state == nullptr) return;
    sys.entry(port.at, at()) = port.per_mass * scale_;
    sys.entry(at(), port.at) = sys.now.seconds * line_.by_port() * port.side.pressure / scale_;
    sys.entry(at(), at()) = sys.now.seconds * line_.by_flow(flow);
  }

  void power(System& sys, const Flows& flows, PowerBudget& power) const override {
    const double drop = sys[kSuction].side.pressure - sys[kTank].side.pressure;
    power[Place::suction_line] = line_.lost(flows.taken);
    // In a line the oil has one density: its potential there is linear in the pressure.
    power[Place::line_density] +=
        flows.taken * (sys.potential(kTank) + drop / line_.density() - sys.potential(kSuction));
  }

  void stored(System& sys, Stored& all) const override {
    all.energy += line_.kinetic_energy(sys.y[at()] * scale_);
  }

  void places(std::vector<Place>& all) const override {
    all.insert(all.end(), {Place::suction_line, Place::line_density});
  }

 private:
  SuctionLine line_;
  double scale_;
};

/// From the delivery port to its far end, at the pressure `end` there, or with what the load takes.
/// States: those of the line.
class DeliveryPipe final : public Element {
 public:
  /// @param about  the oil about which the line is linear
  /// @param end    null: what the load takes
  DeliveryPipe(const TransmissionLine& line, const Held& about, const Held* end)
      : Element(line.size()), line_(line), about_(about), end_(end) {}
  double end_pressure(const double* y) const { return line_.end_pressure(y + at()); }
  void start(const StartOf& start, double* y) const override {
    line_.uniform(start.delivery_pressure, start.mass_flow, y + at());
  }

  void name_states(OilColumn* all) const override {
    for (int i = 0; i < states(); ++i)
      all[at() + i] = {"delivery_line_" + std::to_string(i + 1),
                       "mode of the delivery line's pressure, then of its flow"};
  }

  void connect(System& sys) const override {
    System::Node& end = sys[kFarEnd];
    if (end_ != nullptr) {
      sys.hold(kFarEnd, *end_);
    } else {
      end.side = line_.end_side(sys.y + at());
      end.at = at();
      end.states = line_.pressures();
    }
    end.potential = potential(end.side.pressure);
  }

  void stamp(System& sys) const override {
    System::Node& port = sys[kDelivery];
    const double* modes = sys.y + at();
    port.leaves += line_.inflow(modes);
    if (end_ != nullptr) sys[kFarEnd].arrives = line_.outflow(modes);
    if (sys.by_state == nullptr) return;
    for (int j = line_.pressures(); j < states(); ++j)
      sys.entry(port.at, at() + j) = -port.per_mass * line_.inflow_by(j - line_.pressures());
  }

  void finish(System& sys) const override {
    const double seconds = sys.now.seconds;
    const System::Node &port = sys[kDelivery], &end = sys[kFarEnd];
    if (sys.rates != nullptr) {
      double* rates = sys.rates + at();
      line_.rates(sys.y + at(), port.side.pressure,
                  end_ != nullptr ? end.side.pressure : end.leaves, rates);
      for (int i = 0; i < states(); ++i) rates[i] *= seconds;
    }
    if (sys.by_state == nullptr) return;
    // What is given at the far end follows from the pressure there, which is that of every mode.
    const double by_own = sys.leaves_by_own(kFarEnd);
    for (int i = 0; i < states(); ++i) {
      for (int j = 0; j < states(); ++j)
        sys.entry(at() + i, at() + j) =
            seconds *
            (line_.by_state(i, j) + (j < line_.pressures() ? line_.by_end(i) * by_own : 0));
      sys.stamp_others(kFarEnd, at() + i, seconds * line_.by_end(i));
      sys.entry(at() + i, port.at) = seconds * line_.by_start(i) * port.side.pressure;
    }
  }

  void power(System& sys, const Flows&, PowerBudget& power) const override {
    const double* modes = sys.y + at();
    power[Place::delivery_line] = line_.friction_power(modes);
    power[Place::damped_waves] = line_.damped_power(modes);
    power[Place::line_density] +=
        line_.inflow(modes) * (sys.potential(kDelivery) - potential(sys[kDelivery].side.pressure));
  }

  void stored(System& sys, Stored& all) const override {
    const double mass = line_.mass(sys.y + at());
    all.mass += mass;
    all.energy += mass * about_.potential + line_.energy(sys.y + at());
  }

  void places(std::vector<Place>& all) const override {
    all.insert(all.end(), {Place::delivery_line, Place::damped_waves, Place::line_density});
  }

 private:
  // In a line the oil has one density: its potential there is linear in the pressure.
  double potential(double pressure) const {
    return about_.potential + (pressure - about_.oil.pressure) / about_.oil.density;
  }
  TransmissionLine line_;
  Held about_;
  const Held* end_;
};

/// The load between two terminals, of the size in question.
class LoadBranch final : public Element {
 public:
  LoadBranch(const Load& load, Terminal from, Terminal to)
      : Element(0), load_(load), from_(from), to_(to) {}
  void stamp(System& sys) const override {
    const Load::Flow flow = load_.flow(sys[from_].side, sys[to_].side, sys.load_size);
    sys.flow(from_, to_, {flow.value, flow.by_side, flow.by_outside}, flow.by_size);
    if (sys.flows == nullptr) return;
    sys.flows->load = flow.value;
    sys.flows->relief = flow.relief;
  }

  void power(System& sys, const Flows& flows, PowerBudget& power) const override {
    double front = sys.potential(from_);
    if (to_ != kOutside) front -= sys.potential(to_);
    power[Place::load] = (flows.load - flows.relief) * front;
    power[Place::relief_valve] = flows.relief * front;
  }

  void places(std::vector<Place>& all) const override {
    if (load_.has_relief()) all.push_back(Place::relief_valve);
  }

 private:
  const Load& load_;
  Terminal from_, to_;
};

/// A terminal that is held takes what comes.
class HeldEnd final : public Element {
 public:
  explicit HeldEnd(Terminal at) : Element(0), end_(at) {}
  void stamp(System& sys) const override {
    if (sys.flows != nullptr) sys.flows->load = sys[end_].arrives;
  }

  void power(System& sys, const Flows& flows, PowerBudget& power) const override {
    power[Place::load] = flows.load * sys.potential(end_);
  }

 private:
  Terminal end_;
};

/// Check valves from the tank to both ports of a closed loop; they open in proportion to the
/// pressure that is missing, up to their area.
class ChargeSupply final : public Element {
 public:
  ChargeSupply(const Orifice& orifice, double area, double opening)
      : Element(0), orifice_(orifice), area_(area), opening_(opening) {}
  void stamp(System& sys) const override {
    const MassFlow low = into(sys, kSuction), high = into(sys, kDelivery);
    sys.flow(kTank, kSuction, low);
    sys.flow(kTank, kDelivery, high);
    if (sys.flows != nullptr) sys.flows->taken = low.value + high.value;
  }

  void power(System& sys, const Flows&, PowerBudget& power) const override {
    const double tank = sys.potential(kTank);
    power[Place::charge_valves] = into(sys, kSuction).value * (tank - sys.potential(kSuction)) +
                                  into(sys, kDelivery).value * (tank - sys.potential(kDelivery));
  }

  void places(std::vector<Place>& all) const override { all.push_back(Place::charge_valves); }

 private:
  MassFlow into(System& sys, Terminal port) const {
    const Side &tank = sys[kTank].side, &side = sys[port].side;
    if (side.pressure >= tank.pressure) return {};
    const double share = (tank.pressure - side.pressure) / opening_;
    MassFlow flow = orifice_.flow(area_ * std::min(share, 1.0), tank, side);
    if (share < 1) flow.by_second -= flow.value / share * side.pressure / opening_;
    return flow;
  }
  Orifice orifice_;
  double area_, opening_;
};

/// An accumulator at the delivery port behind its inlet. State: s of its oil.
class AccumulatorBranch final : public Element {
 public:
  AccumulatorBranch(const Accumulator& accumulator, const Orifice& orifice, double inlet_area)
      : Element(1), accumulator_(accumulator), orifice_(orifice), inlet_area_(inlet_area) {}
  void start(const StartOf& start, double* y) const override { y[at()] = start.delivery; }

  void name_states(OilColumn* all) const override {
    all[at()] = {"ln_p_accumulator", "ln(P/P0) in the accumulator"};
  }

  void stamp(System& sys) const override {
    System::Node& port = sys[kDelivery];
    const double s = sys.y[at()];
    const Fluid::State gas = sys.fluid.state(s);
    const MassFlow in = orifice_.flow(inlet_area_, port.side, gas);
    port.leaves += in.value;
    if (sys.flows != nullptr) sys.flows->accumulator = in.value;
    const Accumulator::Oil oil = accumulator_.oil(s);
    const double soft = oil.volume / gas.stiffness + oil.first;
    if (sys.rates != nullptr) sys.rates[at()] = sys.now.seconds * in.value / (gas.density * soft);
    if (sys.by_state == nullptr) return;
    const double hardens =
        (oil.first - oil.volume * gas.d_stiffness / gas.stiffness) / gas.stiffness + oil.second;
    const double factor = sys.now.seconds / (gas.density * soft);
    sys.entry(at(), port.at) = factor * in.by_first;
    sys.entry(at(), at()) =
        factor * (in.by_second - in.value * (1 / gas.density_stiffness + hardens / soft));
    sys.entry(port.at, port.at) -= port.per_mass * in.by_first;
    sys.entry(port.at, at()) = -port.per_mass * in.by_second;
  }

  void power(System& sys, const Flows& flows, PowerBudget& power) const override {
    power[Place::accumulator_inlet] =
        flows.accumulator * (sys.potential(kDelivery) - sys.fluid.potential(sys.y[at()]));
  }

  void stored(System& sys, Stored& all) const override {
    const double s = sys.y[at()];
    all.add(accumulator_.oil(s).volume, sys.fluid.state(s).density, sys.fluid.potential(s),
            sys.fluid.gauge(s));
    all.energy += accumulator_.energy(s);
  }

  void places(std::vector<Place>& all) const override { all.push_back(Place::accumulator_inlet); }

 private:
  Accumulator accumulator_;
  Orifice orifice_;
  double inlet_area_;
};

/// Of a period: the mean so far of the delivery port's gauge pressure, over `scale` and of all
/// `degrees`.
class MeanDelivery final : public Element {
 public:
  MeanDelivery(double scale, double degrees) : Element(1), scale_(scale), degrees_(degrees) {}
  void finish(System& sys) const override {
    const System::Node& port = sys[kDelivery];
    if (sys.rates != nullptr)
      sys.rates[at()] = (port.side.pressure - sys[kOutside].side.pressure) / (scale_ * degrees_);
    if (sys.by_state != nullptr)
      sys.entry(at(), port.at) = port.side.pressure / (scale_ * degrees_);
  }

 private:
  double scale_, degrees_;
};

}  // namespace bentaxis::hydraulics

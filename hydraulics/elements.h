// The elements beside the chambers: volumes, lines, loads, accumulator, charge supply.
#pragma once

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
  void start(const StartOf& start, double* y) const override;
  void name_states(OilColumn* all) const override;
  void connect(System& sys) const override;
  void finish(System& sys) const override;
  void stored(System& sys, Stored& all) const override;

 private:
  Terminal port_;
  double volume_;
};

/// From the tank to the suction port. State: its mass flow over `scale`, kg/s.
class SuctionPipe final : public Element {
 public:
  SuctionPipe(const SuctionLine& line, double scale) : Element(1), line_(line), scale_(scale) {}
  void start(const StartOf& start, double* y) const override;
  void name_states(OilColumn* all) const override;
  void stamp(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;
  void stored(System& sys, Stored& all) const override;
  void places(std::vector<Place>& all) const override;

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
  void start(const StartOf& start, double* y) const override;
  void name_states(OilColumn* all) const override;
  void connect(System& sys) const override;
  void stamp(System& sys) const override;
  void finish(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;
  void stored(System& sys, Stored& all) const override;
  void places(std::vector<Place>& all) const override;

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
  void stamp(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;
  void places(std::vector<Place>& all) const override;

 private:
  const Load& load_;
  Terminal from_, to_;
};

/// A terminal that is held takes what comes.
class HeldEnd final : public Element {
 public:
  explicit HeldEnd(Terminal at) : Element(0), end_(at) {}
  void stamp(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;

 private:
  Terminal end_;
};

/// Check valves from the tank to both ports of a closed loop; they open in proportion to the
/// pressure that is missing, up to their area.
class ChargeSupply final : public Element {
 public:
  ChargeSupply(const Orifice& orifice, double area, double opening)
      : Element(0), orifice_(orifice), area_(area), opening_(opening) {}
  void stamp(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;
  void places(std::vector<Place>& all) const override;

 private:
  MassFlow into(System& sys, Terminal port) const;
  Orifice orifice_;
  double area_, opening_;
};

/// An accumulator at the delivery port behind its inlet. State: s of its oil.
class AccumulatorBranch final : public Element {
 public:
  AccumulatorBranch(const Accumulator& accumulator, const Orifice& orifice, double inlet_area)
      : Element(1), accumulator_(accumulator), orifice_(orifice), inlet_area_(inlet_area) {}
  void start(const StartOf& start, double* y) const override;
  void name_states(OilColumn* all) const override;
  void stamp(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;
  void stored(System& sys, Stored& all) const override;
  void places(std::vector<Place>& all) const override;

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
  void finish(System& sys) const override;

 private:
  double scale_, degrees_;
};

}  // namespace bentaxis::hydraulics

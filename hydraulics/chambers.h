// The chambers between both ports.
#pragma once

#include <vector>

#include "chamber.h"
#include "element.h"
#include "leakage.h"
#include "port.h"

namespace bentaxis::hydraulics {

/// All chambers with their ways to both ports and to the case. States: s of chambers 1..N; and
/// where air takes time to come out (Cavitation::rate) elsewhere the share of the dissolved air
/// that is out in each.
class Chambers final : public Element {
 public:
  /// @param orifice  of both ports, but for the discharge coefficient that a port may have
  Chambers(const Case& the_case, const Fluid& fluid, const Orifice& orifice);

  int count() const { return states(); }
  /// 360/N: after that angle every chamber stands where the one before it stood.
  double apart_deg() const { return 360.0 / count(); }
  /// Angle of chamber k, from 0, where the block stands at an angle.
  double angle_deg(double block_deg, int k) const { return block_deg - apart_deg() * k; }
  const Chamber& one() const { return chamber_; }
  const PortOpening& delivery() const { return delivery_; }
  const PortOpening& suction() const { return suction_; }

  /// Gives the air its place where it takes time; how many states that makes.
  int begin_air_at(int at) {
    if (air_takes_time_) air_at_ = at;
    return air_takes_time_ ? count() : 0;
  }
  int air_at() const { return air_at_; }  ///< 0: it is no state
  Fluid::Mixture mixture(const Fluid& fluid, const double* y, int k) const {
    return air_at_ > 0 ? fluid.mixture(y[k], y[air_at_ + k]) : Fluid::Mixture{fluid.state(y[k])};
  }

  void start(const StartOf& start, double* y) const override;
  /// The air that is out in equilibrium at the chambers' pressures.
  void start_air(const Fluid& fluid, double* y) const;
  void name_states(OilColumn* all) const override;
  void stamp(System& sys) const override;
  void power(System& sys, const Flows& flows, PowerBudget& power) const override;
  void stored(System& sys, Stored& all) const override;
  void places(std::vector<Place>& all) const override;

 private:
  // Where oil comes from: the air that is out there.
  struct Sources {
    Fluid::AirOut suction, delivery, outside;
  };
  Sources sources(System& sys) const;
  // d(air out)/dt of a chamber and its derivatives.
  struct AirRate {
    double value = 0, by_pressure = 0, by_air = 0, by_suction = 0, by_delivery = 0;
  };
  AirRate release(const Fluid& fluid, double s, double air_out) const;  // of its own
  // What a chamber exchanges.
  struct Exchange {
    MassFlow in, out, lost;  // from the suction port, into the delivery port, to the case
    double in_by_air = 0, out_by_air = 0, lost_by_air = 0;
  };
  Exchange exchange(System& sys, double angle_deg, double volume, const Fluid::Mixture& at) const;
  AirRate air_rate(System& sys, int k, const Fluid::Mixture& at, double volume,
                   const Exchange& flows, const Sources& from) const;
  Chamber::Volume volume(const Moment& now, int k) const;

  Chamber chamber_;
  PortOpening delivery_, suction_;
  Orifice into_delivery_, from_suction_;
  Leakage leakage_;
  bool air_takes_time_;  // else it is out as in equilibrium
  double release_time_, dissolution_time_;
  Held case_;
  int air_at_ = 0;
};

}  // namespace bentaxis::hydraulics

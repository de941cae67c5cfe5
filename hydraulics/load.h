// What the pump delivers against.
#pragma once

#include "bentaxis/pump/hydraulic_data.h"
#include "orifice.h"

namespace bentaxis::hydraulics {

/// Mass flow out of the delivery side, to the atmosphere or, in a closed loop, to the suction side.
/// `size` is what may be sought: the area of an orifice, m2; the conductance of a laminar load,
/// m3/(s Pa); P0 + the cracking pressure of a relief valve, Pa; of a given flow what it is times. A
/// relief valve's area is a = k (p - cracking), p the difference of pressures, held between 0 and
/// its full area; its flow is that of an orifice. Given flow: the same whatever the pressure, but
/// that none is drawn where there is none: times tanh(p/pcr), which is 1 from 20 pcr on. A relief
/// valve may stand beside an orifice, a laminar load and a given flow. In a closed loop all of them
/// act in both directions.
class Load {
 public:
  /// @param given_mass_flow  kg/s, of LoadKind::flow
  Load(const LoadData& data, const Orifice& orifice, const Fluid& fluid, double given_mass_flow,
       bool both_ways = false);

  LoadKind kind() const { return data_.kind; }
  /// Whether the size is sought; a given flow has none, a constant pressure neither.
  bool sought() const;
  /// The size where it is given.
  double size() const;
  /// The size that lets nothing pass.
  double closed() const;
  /// The size that passes a mass flow from `side`, so far as one does.
  double size_for(double mass_flow, const Side& side, const Side& outside) const;
  double size_for(double mass_flow, const Side& side) const {
    return size_for(mass_flow, side, outside_);
  }
  /// A size times a share; of a relief valve that of its cracking pressure.
  double shared(double size, double share) const;
  bool has_relief() const { return data_.has_relief(); }

  struct Flow {
    double value = 0;       ///< kg/s, all
    double by_side = 0;     ///< by the state of the side
    double by_size = 0;     ///< by ln(size)
    double by_outside = 0;  ///< by the state of the other side
    double relief = 0;      ///< of the value: over the relief valve beside the load
  };
  Flow flow(const Side& side, const Side& outside, double size) const;
  Flow flow(const Side& side, double size) const { return flow(side, outside_, size); }

 private:
  Flow through_load(const Side& side, const Side& outside, double size) const;
  Flow through_valve(const Side& side, const Side& outside, double size) const;
  Flow one_way(const Side& side, const Side& outside, double size) const;

  LoadData data_;
  Orifice orifice_;
  Fluid::State outside_;
  double given_;
  bool both_ways_;
};

}  // namespace bentaxis::hydraulics

// What the pump delivers against.
#pragma once

#include "bentaxis/pump/hydraulic_data.h"
#include "orifice.h"

namespace bentaxis::hydraulics {

/// Mass flow out of the delivery side, to the atmosphere. `size` is what may be sought: the area of
/// an orifice, m2; the conductance of a laminar load, m3/(s Pa); the absolute cracking pressure of
/// a relief valve, Pa. A relief valve's area is a = k (P - cracking), held between 0 and its full
/// area; its flow is that of an orifice. Given flow: the same whatever the pressure.
class Load {
 public:
  /// @param given_mass_flow  kg/s, of LoadKind::flow
  Load(const LoadData& data, const Orifice& orifice, const Fluid& fluid, double given_mass_flow);

  LoadKind kind() const { return data_.kind; }
  /// Whether the size is sought; a given flow has none, a constant pressure neither.
  bool sought() const;
  /// The size where it is given.
  double size() const;
  /// The size that lets nothing pass.
  double closed() const;
  /// The size that passes a mass flow from `side`, so far as one does.
  double size_for(double mass_flow, const Side& side) const;

  struct Flow {
    double value = 0;    ///< kg/s
    double by_side = 0;  ///< by the state of the side
    double by_size = 0;  ///< by ln(size)
  };
  Flow flow(const Side& side, double size) const;

 private:
  LoadData data_;
  Orifice orifice_;
  Fluid::State outside_;
  double given_;
};

}  // namespace bentaxis::hydraulics

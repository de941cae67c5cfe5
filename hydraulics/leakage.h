// Leakage of a chamber to the case.
#pragma once

#include <optional>

#include "bentaxis/pump/case.h"
#include "chamber.h"
#include "orifice.h"
#include "viscosity.h"

namespace bentaxis::hydraulics {

/// Laminar: a constant conductance, and gaps side by side. Through a gap of conductance g(theta) in
/// m3 the volume flow is g times the integral of dp/mu; mass flow = density x volume flow, density
/// the mean of both sides. With radial gap h, diameter D, eccentricity e and length l:
///
/// - piston: pi D h^3 (1 + 1.5 e^2) / (12 l); l given, or l + what of the piston is in the bore
/// more
///   than at its outer dead centre;
/// - port plate: the kidney's width w as a sector whose lands leak outwards and inwards to the
/// case:
///   w h^3 / 12 (1/ln(r4/r3) + 1/ln(r2/r1));
/// - joint of a piston ring: b h^3 / (12 l).
class Leakage {
 public:
  Leakage(const Case& the_case, const Fluid& fluid, const Chamber& chamber);

  /// From a chamber of that volume, m3, to the case.
  MassFlow flow(const Fluid::State& chamber, double volume) const;
  double value(const Fluid::State& chamber, double volume) const;  ///< of it alone, kg/s
  /// Conductance of all gaps of a chamber of that volume, m3.
  double gaps(double volume) const;
  /// The same flow by where it goes through, kg/s; what is not there is 0.
  struct Parts {
    double conductance = 0, piston_gap = 0, plate_gap = 0, ring_slot = 0;
  };
  Parts parts(const Fluid::State& chamber, double volume) const;
  bool has_conductance() const { return constant_ > 0; }
  bool has_piston_gap() const { return piston_ > 0; }
  bool has_plate_gap() const { return plate_ > 0; }
  bool has_ring_slot() const { return ring_ > 0; }

 private:
  double piston_gap(double volume) const;  // m3

  double constant_;  // m3/(s Pa)
  Fluid::State case_state_;
  double atmosphere_;
  std::optional<Viscosity> viscosity_;                 // none: no gaps
  double plate_ = 0, ring_ = 0;                        // m3, of the gaps that do not change
  double piston_ = 0;                                  // m4, of the piston's gap, x length
  double length_ = 0, area_ = 0, largest_volume_ = 0;  // area 0: the length does not change
};

}  // namespace bentaxis::hydraulics

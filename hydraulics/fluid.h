// Oil with entrained air.
#pragma once

#include "bentaxis/pump/hydraulic_data.h"

namespace bentaxis::hydraulics {

/// A fixed mass of oil of constant bulk modulus K and, beside it, a fixed mass of air that obeys
/// P V^n = const. Per unit of volume at atmospheric pressure P0 the mixture takes up
///
///   v(P) = (1 - x) exp(-(P - P0)/K) + x (P0/P)^(1/n),      density = rho0 (1 - x) / v,
///
/// x the share of air; the mass of the air itself is neglected. All functions are of
/// s = ln(P/P0), P absolute: any finite s is a pressure above absolute zero, and at low pressure
/// the air makes the mixture so soft that s stays finite. Air does not dissolve; no vapour.
class Fluid {
 public:
  explicit Fluid(const HydraulicData& data);

  /// What the balance of mass needs at one state.
  struct State {
    double pressure = 0;     ///< P, Pa absolute; dP/ds = P
    double density = 0;      ///< kg/m3
    double stiffness = 0;    ///< K(P)/P = d ln(density) / ds inverted; K(P) the effective modulus
    double d_stiffness = 0;  ///< its derivative with respect to s
  };
  State state(double s) const;

  /// s of a gauge pressure, Pa. Needs gauge > -atmosphere.
  double log_pressure(double gauge) const;
  /// Gauge pressure of s, Pa.
  double gauge(double s) const;
  /// Density at a gauge pressure, kg/m3.
  double density(double gauge) const { return state(log_pressure(gauge)).density; }
  /// Effective bulk modulus K(P) = density dP/d(density) at a gauge pressure, Pa.
  double effective_bulk_modulus(double gauge) const;

  double atmosphere() const { return atmosphere_; }

 private:
  double atmosphere_, bulk_modulus_, air_share_, inverse_exponent_, reference_density_;
};

}  // namespace bentaxis::hydraulics

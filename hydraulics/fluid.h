// Oil with entrained air, dissolved air and vapour.
#pragma once

#include <cmath>
#include <vector>

#include "bentaxis/pump/hydraulic_data.h"

namespace bentaxis::hydraulics {

/// A fixed mass of oil, beside it a fixed mass of entrained air that obeys P V^n = const, and air
/// dissolved in the oil. Per unit of volume of oil and entrained air at atmospheric pressure P0 the
/// mixture takes up
///
///   v = (1 - x) (1 + K' (P - P0)/K)^(-1/K') + x ((P0 - Pv)/(P - Pv))^(1/n)
///     + (1 - x) y (P0/(P - Pv) - P0/(Ps - Pv)),                 density = rho0 (1 - x) / v,
///
/// exp(-(P - P0)/K) for K' = 0, the last term below the saturation pressure Ps only. x is the share
/// of entrained air, y the volume at P0 of the air dissolved at saturation. Dalton: bubbles hold
/// saturated vapour of pressure Pv, so that the air's own is P - Pv. Henry: the oil keeps the share
/// (P - Pv)/(Ps - Pv) of its air, in equilibrium at each pressure; what has come out is as warm as
/// the oil. The masses of air and vapour are neglected. Cavitation::ignored is y = Pv = 0.
///
/// With Cavitation::rate the share phi of the dissolved air that is out is a state of its own: the
/// last term is (1 - x) y phi P0/(P - Pv), which is the same at phi in equilibrium.
///
/// All functions are of s = ln(P/P0), P absolute: any finite s is a pressure above absolute zero,
/// and at low pressure the air makes the mixture so soft that s stays finite. Two kinks are rounded
/// by w(t) = b ln(1 + exp(t/b)) in place of max(t, 0), all derivatives continuous: Henry's at
/// t = ln((Ps - Pv)/(P - Pv)), b = 0.02 (nothing is left of it beyond a factor 2 in pressure); and
/// t = ln(P/Pv), b = 0.002 (nothing is left 8 % above Pv), so that the law goes on, ever steeper, a
/// few percent below Pv.
///
/// OilLaw::dissolving_air multiplies the entrained air by the share that is not dissolved yet,
/// 1 - 3 L^2 + 2 L^3 with L = (P - P0)/(Pc - P0) held to [0, 1]. OilLaw::dowson_higginson has
/// (1 + b p)/(1 + (a + b) p), p = P - P0, in place of the oil's exponential.
///
/// OilLaw::constant_density is no law of a mixture: rho0 in every flow and balance, and dP = -K
/// dV/V. It keeps neither mass nor energy. Nothing bounds its s from below; where a volume has too
/// little oil, its pressure comes to rest at `lowest_pressure` (see expanding()).
class Fluid {
 public:
  explicit Fluid(const HydraulicData& data);

  /// What the balance of mass needs at one state.
  struct State {
    double pressure = 0;     ///< P, Pa absolute; dP/ds = P
    double density = 0;      ///< kg/m3
    double stiffness = 0;    ///< K(P)/P = d ln(density) / ds inverted; K(P) the effective modulus
    double d_stiffness = 0;  ///< its derivative with respect to s
    /// ds / d ln(density): the stiffness, but infinite where the density is held constant.
    double density_stiffness = 0;
  };
  State state(double s) const;

  /// The same with the share of the dissolved air that is out given. Air being out
  /// makes the mixture larger: d ln(density) = ds/stiffness - swelling d(air out).
  struct Mixture : State {
    double swelling = 0, d_swelling = 0;  ///< and its derivative with respect to s
    double stiffness_by_air = 0;          ///< d(stiffness)/d(air out)
    double swelling_by_air = 0;
  };
  Mixture mixture(double s, double air_out) const;
  /// The share of the dissolved air that is out in equilibrium, and its derivative: 0 to nearly 1.
  struct AirOut {
    double value = 0, slope = 0;
  };
  AirOut equilibrium(double s) const;

  /// OilLaw::constant_density: what is left of the rate of a pressure that falls, 1 - Pmin/P, so
  /// that it ends at Pmin; and its derivative by s. 1 and 0 by the other laws.
  struct Expanding {
    double value = 1, slope = 0;
  };
  Expanding expanding(double s) const {
    if (!constant_density_) return {};
    const double left = lowest_pressure_ / (atmosphere_ * std::exp(s));
    return {1 - left, left};
  }

  /// s of a gauge pressure, Pa. Needs gauge > -atmosphere.
  double log_pressure(double gauge) const;
  /// Gauge pressure of s, Pa.
  double gauge(double s) const;
  /// Density at a gauge pressure, kg/m3.
  double density(double gauge) const { return state(log_pressure(gauge)).density; }
  /// Effective bulk modulus K(P) = density dP/d(density) at a gauge pressure, Pa.
  double effective_bulk_modulus(double gauge) const;
  /// Pressure potential, J/kg: the integral of dP/density from atmospheric pressure. A mass flow m
  /// carries m x potential, and what it loses between two pressures is m x their difference.
  double potential(double s) const;
  double potential(double s, const State& there) const;  ///< the same, of the state at s
  /// The same with the share of the dissolved air that is out given, and what it grows by with it.
  double potential(double s, double air_out) const;
  double potential_by_air(double s) const;

  double atmosphere() const { return atmosphere_; }

  /// Pressures below which dissolved air comes out and oil boils, Pa gauge; also where the law
  /// leaves both out, so that a result can be held against them.
  double saturation() const { return saturation_; }
  double vapour() const { return vapour_ - atmosphere_; }
  bool below_saturation(double s) const { return gauge(s) < saturation_; }
  bool below_vapour(double s) const { return gauge(s) < vapour(); }
  /// Share of the dissolved air that has come out, 0..1.
  double released_air(double s) const;
  /// Share of the volume that bubbles take: entrained and released air with its vapour.
  double bubbles(double s) const;

 private:
  // A function of s with two derivatives.
  struct Smooth {
    double value = 0, first = 0, second = 0;
  };
  Smooth air_pressure(double s) const;             // ln of the air's own over that at P0
  Smooth under_saturation(const Smooth& q) const;  // ln((Ps - Pv)/(P - Pv)), at least 0
  struct Volumes {
    Smooth oil, air, released;  // first: -dv/ds
  };
  Volumes volumes(double s, double pressure) const;
  Smooth oil_volume(double pressure) const;  // first: -dv/ds
  Smooth undissolved(double pressure) const;
  // Volume of all of the dissolved air, out.
  double all_released(const Smooth& q) const {
    return dissolves_ ? released_scale_ * std::exp(log_saturation_ - q.value) : 0;
  }
  void add_oil_and_air(double pressure, const Smooth& q, Volumes& v) const;
  State state_of(const Volumes& v, double pressure) const;
  double oil_potential(double pressure) const;  // integral of the oil's own v dP
  double potential_at(double s, double pressure) const;
  // The same of the bubbles where no closed form is: sums up to places in s between which few
  // points are enough.
  struct Bubbles {
    double air = 0;       // entrained
    double released = 0;  // in equilibrium
    double all = 0;       // all of the dissolved air, out
  };
  void sum_up_bubbles();
  Bubbles bubble_potential(double s) const;
  Bubbles bubbles_between(double from, double to) const;

  double atmosphere_, bulk_modulus_, modulus_slope_, air_share_, inverse_exponent_,
      reference_density_;
  double saturation_, vapour_;  // Pa gauge, Pa absolute
  bool boils_, dissolves_;
  bool air_dissolves_, dowson_higginson_, constant_density_;
  double dissolved_pressure_;                         // Pa gauge
  double compressibility_, compressibility_limited_;  // a and a + b, 1/Pa
  double lowest_pressure_;                            // Pa absolute
  double log_vapour_ = 0, vapour_over_air_ = 0;       // ln(Pv/P0), ln(Pv/(P0 - Pv))
  double log_saturation_ = 0;                         // ln((Ps - Pv)/(P0 - Pv))
  double released_scale_ = 0;                         // (1 - x) y P0/(Ps - Pv)
  std::vector<double> places_;                        // in s, rising
  std::vector<Bubbles> sums_;                         // of the bubbles' potential there
};

}  // namespace bentaxis::hydraulics

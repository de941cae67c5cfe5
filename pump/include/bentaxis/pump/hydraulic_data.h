// The raw description of the hydraulic side of a pump: oil, ports, leakage, delivery line.
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis {

/// How the opening of a silencing notch grows with the length of it that the kidney has passed.
enum class NotchLaw {
  quadratic,  ///< V groove whose width and depth grow alike: area in proportion to the square
  linear,     ///< groove of constant depth: area in proportion to the length
};

/// Silencing notch in front of a port: it leads the port's leading edge by `length_deg`.
struct Notch {
  double length_deg = 0;  ///< 0 = no notch
  double area = 0;        ///< m2, at its root, where it meets the port
};

/// One port of the fixed plate as the kidneys of the block see it.
struct PlatePort {
  PortArc arc;  ///< degrees; psi as in PortArc
  Notch notch;
};

/// All that the chamber pressures depend on beyond geometry and speed. Pressures in Pa; those of
/// `[pressure]` and of the case are gauge.
struct HydraulicData {
  // Oil with entrained air.
  double density = 0;       ///< kg/m3, of the oil without air at atmospheric pressure
  double bulk_modulus = 0;  ///< Pa, of the oil without air, isentropic
  double air_share = 0;     ///< volume of air / volume of both at atmospheric pressure, > 0
  double air_exponent = 0;  ///< polytropic exponent n of the air, p V^n = const
  double atmosphere = 0;    ///< Pa absolute, where gauge pressure is 0
  // Flow between the kidney of a chamber (in the block) and the ports of the plate.
  PlatePort delivery, suction;
  double kidney_width_deg = 0;     ///< of a block kidney, seen from the block axis
  double kidney_height = 0;        ///< m, radial
  double kidney_rounding_deg = 0;  ///< overlap over which the opening grows as its square
  NotchLaw notch_law = NotchLaw::quadratic;
  double discharge_coefficient = 0;  ///< Cd
  double transition_pressure = 0;    ///< Pa, p_cr: below it the orifices are about linear
  // The rest.
  double leakage = 0;          ///< m3/(s Pa), each chamber to the case, laminar
  double case_pressure = 0;    ///< Pa gauge
  double dead_volume = 0;      ///< V0, m3: smallest volume of a chamber
  double delivery_volume = 0;  ///< m3, between pump and load orifice
  double tolerance = 0;        ///< relative error of pressure per step of the time integration
  double curve_error = 1e-7;   ///< largest of the computed curve, of its peak
};

}  // namespace bentaxis

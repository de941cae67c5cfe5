// Viscosity of oil over temperature and pressure.
#pragma once

#include "bentaxis/pump/hydraulic_data.h"

namespace bentaxis::hydraulics {

/// Kinematic viscosity nu in mm2/s over the temperature T in kelvin by Walther's law (ASTM D341),
/// lg lg(nu + 0.7) = a - b lg T, through the two values given; dynamic viscosity over the gauge
/// pressure p by Barus' law, mu = mu(0) exp(alpha_mu p).
class Viscosity {
 public:
  /// @param density  kg/m3, at the oil's temperature and atmospheric pressure
  Viscosity(const OilData& oil, double density);

  /// m2/s, at the oil's temperature and atmospheric pressure.
  double kinematic() const { return kinematic_; }
  /// Pa s.
  double dynamic(double gauge) const;
  /// Integral of dp/mu from `low` to `high`, Pa gauge: what drives a laminar gap, 1/s. Exact for a
  /// gap whose walls are parallel: its viscosity falls along it with the pressure.
  double drive(double high, double low) const;

 private:
  double kinematic_, at_atmosphere_, alpha_;
};

}  // namespace bentaxis::hydraulics

// A pipe from the tank to the suction port.
#pragma once

#include <cmath>

#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/units.h"
#include "fluid.h"

namespace bentaxis::hydraulics {

/// The column of oil in a pipe of length L and area A, as one mass, with the loss zeta rho v|v|/2
/// and that of laminar flow: (L/A) dm/dt = P_tank - P_port - zeta m|m|/(2 rho A^2) - 32 nu L m/(A
/// D^2), rho that in the tank.
class SuctionLine {
 public:
  /// @param viscosity  m2/s, kinematic; 0: no laminar loss
  SuctionLine(const SuctionLineData& data, const Fluid::State& tank, double viscosity)
      : density_(tank.density),
        area_per_length_(area(data) / data.length),
        loss_(data.loss / (2 * tank.density * area(data) * area(data))),
        laminar_(32 * viscosity * data.length / (area(data) * data.diameter * data.diameter)) {}

  double density() const { return density_; }
  /// dm/dt, kg/s2, of the mass flow m into the port, kg/s, between pressures in Pa, and its
  /// derivatives.
  double rate(double tank, double port, double m) const {
    return area_per_length_ * (tank - port - loss_ * m * std::abs(m) - laminar_ * m);
  }
  /// Power that the flow m loses in the pipe, W.
  double lost(double m) const { return m * (loss_ * m * std::abs(m) + laminar_ * m) / density_; }
  /// Of the oil in the pipe, J.
  double kinetic_energy(double m) const { return m * m / (2 * density_ * area_per_length_); }
  double by_port() const { return -area_per_length_; }
  double by_flow(double m) const {
    return -area_per_length_ * (2 * loss_ * std::abs(m) + laminar_);
  }

 private:
  static double area(const SuctionLineData& data) {
    return kPi / 4 * data.diameter * data.diameter;
  }
  double density_, area_per_length_, loss_, laminar_;
};

}  // namespace bentaxis::hydraulics

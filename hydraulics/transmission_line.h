// A pipe between the delivery volume and the load, in which pressure waves run.
#pragma once

#include "bentaxis/pump/hydraulic_data.h"
#include "fluid.h"
#include "orifice.h"

namespace bentaxis::hydraulics {

/// One-dimensional flow, linear about the oil at one pressure (density rho, wave speed c), over
/// 0 <= x <= L in a pipe of area A, with the friction of steady laminar flow:
///
///   (A/c^2) dp/dt = -dm/dx,      (1/A) dm/dt = -dp/dx - (32 nu/D^2) m/A,
///
/// p in Pa, m mass flow. Given are p at x = 0, where the delivery volume is, and at x = L either
/// the mass flow that the load takes or the pressure of a line that is held there. p and m are sums
/// of Legendre polynomials of degree up to n, the modes, and both equations hold in the mean over
/// every one of them (Galerkin), what is given at the ends entering through integration by parts
/// (cf. Moulla, Lefevre, Maschke, J. Comput. Phys. 231 (2012) 1272-1292). Above the bandwidth f
/// waves would run too fast: there they are damped, mode i >= 2 at (2n+1) c/L ((i-1)/(n-1))^16 per
/// second. What enters and does not leave is stored, steady flow is exact, and with n = 2 pi f L/c
/// + 2 waves are right to 1e-3 up to the bandwidth.
///
/// State: modes of (p - reference)/reference, then those of m c/(A reference).
class TransmissionLine {
 public:
  enum class End { given_flow, given_pressure };

  /// @param oil  the state about which it is linear
  /// @param viscosity  m2/s, kinematic; 0: no friction
  TransmissionLine(const DeliveryLineData& data, End end, const Fluid::State& oil,
                   double viscosity);

  /// Degree of the polynomials at which waves are right up to the bandwidth.
  static int degree(double bandwidth, double length, double wave_speed);

  int size() const { return pressures_ + flows_; }

  /// Uniform pressure, Pa absolute, and flow, kg/s.
  void uniform(double pressure, double flow, double* y) const;

  double inflow(const double* y) const;        ///< kg/s at x = 0
  double end_pressure(const double* y) const;  ///< Pa absolute at x = L, End::given_flow
  /// The oil there, density held; its state is any mode of pressure.
  Side end_side(const double* y) const;
  double outflow(const double* y) const;  ///< kg/s, End::given_pressure
  /// Derivative of the inflow by mode j of the flow.
  double inflow_by(int j) const { return j % 2 == 0 ? flow_scale_ : -flow_scale_; }

  /// dy/dt.
  /// @param start  Pa absolute at x = 0
  /// @param end    kg/s or Pa absolute at x = L, as given there
  void rates(const double* y, double start, double end, double* dy) const;
  /// d(dy_i/dt)/dy_j; by `start` and by `end`.
  double by_state(int i, int j) const;
  double by_start(int i) const;
  double by_end(int i) const;

  /// Power that friction takes, and that the damping above the bandwidth takes, W: the rates keep
  /// the sum of them, of the energy of the modes and of what passes the ends, (p - reference) m /
  /// density, which is what links pressure and power in oil of one density.
  double friction_power(const double* y) const;
  double damped_power(const double* y) const;

  /// That energy of the modes, J, and the mass in the pipe, kg.
  double energy(const double* y) const;
  double mass(const double* y) const;

  int pressures() const { return pressures_; }  ///< modes of pressure, the first ones of the state
  double wave_speed() const { return wave_speed_; }
  /// Characteristic impedance c/A, Pa s/kg.
  double impedance() const { return reference_ / flow_scale_; }

 private:
  double damping_of(int i) const;                                             // 1/s
  double scale_of(int i) const { return rate_ * (2 * i + 1) / 2; }            // 1/s
  double power_scale() const { return reference_ * flow_scale_ / density_; }  // W

  End end_;
  double wave_speed_, density_, reference_;
  double flow_scale_;  // A reference/c
  double rate_;        // 2 c/L
  double friction_;    // 1/s
  int pressures_, flows_;
};

}  // namespace bentaxis::hydraulics

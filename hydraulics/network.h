// The equations of the pump's hydraulic side: N chambers, two ports, a delivery volume, a load.
#pragma once

#include <cstddef>
#include <vector>

#include "bentaxis/pump/case.h"
#include "chamber.h"
#include "fluid.h"
#include "port.h"

namespace bentaxis::hydraulics {

/// Rates of change of all pressures with the shaft angle x (degrees, which is where edges are
/// exact) at constant speed.
///
/// State: s_1..s_N of the chambers, s = ln(P/P0); with a load also s_d of the delivery volume and
/// the mean so far of its gauge pressure over the pressure asked for. Chamber k stands at
/// x - 360 (k-1)/N degrees. Balance of mass of a chamber with d(density)/density = dP/K:
///
///   ds/dx = (K/P) (dt/dx sum(mass flows)/(density V) - (dV/dx)/V),
///
/// mass flow through an orifice Cd a sqrt(2 density) dp/(dp^2 + pcr^2)^(1/4), density the mean of
/// both sides; leakage to the case laminar. With a delivery pressure of 0 the line is open: it
/// stays at atmospheric pressure and there is no load.
class Network {
 public:
  /// @throws InputError where a case file that says the same would be refused; at standstill,
  /// backwards, and where the pistons have no stroke
  explicit Network(const Case& the_case);

  int pistons() const { return n_; }
  bool open_line() const { return open_; }
  /// Pressures in the state: N, or N + 1 with a load.
  int pressures() const { return open_ ? n_ : n_ + 1; }
  /// Length of the state: pressures, and with a load the mean.
  int size() const { return open_ ? n_ : n_ + 2; }
  /// 360/N: after that angle every chamber stands where the one before it stood.
  double period_deg() const { return 360.0 / n_; }
  /// Angles in (0, period) where any area has an edge, rising.
  const std::vector<double>& edges_deg() const { return edges_deg_; }

  /// d(state)/dx. False where a value is not finite.
  bool rates(double x, const double* y, double load_area, double* dy) const;
  /// d(rates)/d(state), column-major size() x size(); and d(rates)/d(ln load_area), size().
  void jacobian(double x, const double* y, double load_area, double* by_state,
                double* by_load) const;

  /// Mass flows at one state, kg/s; positive as named.
  struct Flows {
    std::vector<double> suction;   ///< from the suction port into each chamber
    std::vector<double> delivery;  ///< from each chamber into the delivery port
    std::vector<double> leakage;   ///< from each chamber to the case
    double load = 0;               ///< from the delivery volume; open line: all of the delivery
    double power = 0;              ///< of the pistons on the oil: -sum p dV/dt, W, p gauge
  };
  void flows(double x, const double* y, double load_area, Flows& flows) const;

  const Fluid& fluid() const { return fluid_; }
  const Chamber& chamber() const { return chamber_; }
  const PortOpening& delivery() const { return delivery_; }
  const PortOpening& suction() const { return suction_; }
  double seconds_per_degree() const { return seconds_per_degree_; }
  double suction_log_pressure() const { return suction_s_; }
  double delivery_log_pressure() const { return delivery_s_; }  ///< of the mean asked for
  double delivery_pressure() const { return delivery_pressure_; }
  /// Area that passes a mass flow at the delivery pressure asked for, m2. Not for an open line.
  double load_area_for(double mass_flow) const;
  /// Displacement of the pump, m3 per revolution.
  double displacement() const { return n_ * chamber_.swept(); }
  double angle_deg(double x, int k) const { return x - period_deg() * k; }  ///< k from 0

 private:
  // Mass flow from side 1 to side 2 and its derivatives with respect to s on either side.
  struct Flow {
    double value = 0, by_first = 0, by_second = 0;
  };
  Flow orifice(double area, const Fluid::State& first, const Fluid::State& second) const;
  Flow leak(const Fluid::State& chamber) const;

  int n_;
  bool open_;
  Fluid fluid_;
  Chamber chamber_;
  PortOpening delivery_, suction_;
  double seconds_per_degree_, leakage_, delivery_volume_, discharge_, transition_squared_;
  double suction_s_, delivery_s_, delivery_pressure_;
  Fluid::State suction_state_, case_state_, outside_;
  std::vector<double> edges_deg_;
};

}  // namespace bentaxis::hydraulics

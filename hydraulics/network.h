// The equations of the pump's hydraulic side: N chambers, two ports, lines, a load.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "accumulator.h"
#include "bentaxis/hydraulics/power.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/oil.h"
#include "chamber.h"
#include "fluid.h"
#include "leakage.h"
#include "load.h"
#include "orifice.h"
#include "port.h"
#include "suction_line.h"
#include "transmission_line.h"

namespace bentaxis::hydraulics {

/// Rates of change of all pressures: with the shaft angle x (degrees, which is where edges are
/// exact) at constant speed, or with time while shaft and block turn anyhow.
///
/// State: s_1..s_N of the chambers, s = ln(P/P0); then, of what there is, s_d of the delivery
/// volume, s_s of the volume at the suction port and the flow of the suction line over the ideal
/// one, the modes of the delivery line, s of the accumulator; where air takes time to come out
/// (Cavitation::rate) the share of the dissolved air that is out in each chamber; and, of a period,
/// with a delivery volume the mean so far of its gauge pressure over the pressure asked for.
/// Chamber k stands at x - 360 (k-1)/N degrees. Balance of mass of a volume with d(density)/density
/// = dP/K:
///
///   ds/dx = (K/P) (dt/dx sum(mass flows)/(density V) - (dV/dx)/V),
///
/// in time x is the time itself and dV/dx = dV/dtheta theta' + dV/dpsi psi'.
///
/// A delivery line at constant pressure (0 among them, an open line) without a pipe before it has
/// no state: the delivery port stays at that pressure and takes what comes.
class Network {
 public:
  /// What the equations are for.
  enum class Use {
    period,  ///< a periodic state at constant speed: per degree, with the mean as a state
    time,    ///< any motion: per second
  };
  /// @throws InputError where a case file that says the same would be refused; where the pistons
  /// have no stroke; of a period at standstill, and backwards without a supply or a given load
  explicit Network(const Case& the_case, Use use = Use::period);

  /// Of motion in time: the pressure in the tank, or of the charge supply, Pa gauge, instead of the
  /// case's; and that at which the delivery side is held. Scales of the states, volumes at suction
  /// density and what lines are linear about stay those of the case.
  void set_suction(std::optional<double> gauge);
  void set_delivery(std::optional<double> gauge);

  /// Where shaft and block stand, and how they move while the states change.
  struct Moment {
    double block_deg = 0;     ///< chambers meet the ports at the block's angle
    double seconds = 1;       ///< time per unit of what rates are by
    double turning = 1;       ///< what a volume's slope is times, for the same unit
    AxisMotion shaft, block;  ///< where they are not locked
    bool locked = true;       ///< both at block_deg, a volume's slope is by the angle
  };
  /// At constant speed, per degree.
  Moment at(double x) const;
  /// Per second.
  static Moment at(const AxisMotion& shaft, const AxisMotion& block);

  int pistons() const { return n_; }
  /// Whether the delivery port is held at a pressure, without a delivery volume in the state.
  bool fixed_line() const { return fixed_; }
  /// Whether the delivery side is held at a pressure, behind a delivery line or without.
  bool fixed_end() const { return fixed_end_; }
  /// Whether the size of the load is one more unknown, for which the mean delivery pressure is
  /// given.
  bool load_sought() const { return sought_; }
  const Load& load() const { return load_; }
  /// Pressures of chambers and delivery volume, the first of the state: N, or N + 1.
  int pressures() const { return fixed_ ? n_ : n_ + 1; }
  /// What comes back after a period, the first of the state: all but the mean.
  int states() const { return states_; }
  /// Name and meaning of each of the state, of motion in time.
  std::vector<OilColumn> state_columns() const;
  /// Length of the state.
  int size() const { return fixed_ || use_ == Use::time ? states_ : states_ + 1; }
  /// 360/N: after that angle every chamber stands where the one before it stood.
  double period_deg() const { return 360.0 / n_; }
  /// Angles in (0, period) where any area has an edge, rising.
  const std::vector<double>& edges_deg() const { return edges_deg_; }

  /// d(state)/dx. False where a value is not finite.
  bool rates(const Moment& now, const double* y, double load_size, double* dy) const;
  bool rates(double x, const double* y, double load_size, double* dy) const {
    return rates(at(x), y, load_size, dy);
  }
  /// d(rates)/d(state), column-major size() x size(); and d(rates)/d(ln load_size), size(), where
  /// it is not null.
  void jacobian(const Moment& now, const double* y, double load_size, double* by_state,
                double* by_load) const;
  void jacobian(double x, const double* y, double load_size, double* by_state,
                double* by_load) const {
    jacobian(at(x), y, load_size, by_state, by_load);
  }

  /// Mass flows at one state, kg/s; positive as named.
  struct Flows {
    std::vector<double> suction;   ///< from the suction port into each chamber
    std::vector<double> delivery;  ///< from each chamber into the delivery port
    std::vector<double> leakage;   ///< from each chamber to the case
    double load = 0;               ///< into the load; fixed line: all of the delivery
    double relief = 0;             ///< of that: over the relief valve beside the load
    double taken = 0;              ///< from the tank, or from the charge supply
    double accumulator = 0;        ///< into the accumulator
    double power = 0;              ///< of the pistons on the oil: -sum p dV/dt, W, p gauge
  };
  void flows(const Moment& now, const double* y, double load_size, Flows& flows) const;
  void flows(double x, const double* y, double load_size, Flows& flows) const {
    this->flows(at(x), y, load_size, flows);
  }

  /// Mass flow into the load alone, kg/s.
  double load_flow(double x, const double* y, double load_size) const;

  /// Power by place at one state, W, from its flows.
  PowerBudget power(const Moment& now, const double* y, const Flows& flows) const;
  PowerBudget power(double x, const double* y, const Flows& flows) const {
    return power(at(x), y, flows);
  }
  /// What the oil carries out of the pump with the volume at its delivery port less what it carries
  /// in to the suction port at one state, W: PumpPower::useful is its mean over a period.
  double port_power(const double* y, const Flows& flows) const;
  /// What the circuit holds: with the power by place, d(energy)/dt is sources less all else.
  struct Stored {
    double energy = 0, mass = 0;  ///< J, kg
  };
  Stored stored(const Moment& now, const double* y) const;
  /// The places that this circuit has, and of how many from the first on they are.
  std::vector<Place> places() const;
  int place_count() const;

  const Fluid& fluid() const { return fluid_; }
  const Chamber& chamber() const { return chamber_; }
  const PortOpening& delivery() const { return delivery_; }
  const PortOpening& suction() const { return suction_; }
  double seconds_per_degree() const { return seconds_per_degree_; }
  double suction_log_pressure() const { return suction_s_; }
  double delivery_log_pressure() const { return delivery_s_; }  ///< of the mean asked for
  /// Of the high side as a search may begin: the one asked for; in a closed loop, which forgets too
  /// high a one by leakage alone, that at which a load of given size takes a share of the ideal
  /// flow.
  double expected_log_pressure(double share) const;
  double delivery_pressure() const { return delivery_pressure_; }
  /// What the mean in the state is a multiple of, Pa.
  double mean_scale() const { return mean_scale_; }
  /// Gauge pressure of the delivery volume, or of the fixed line.
  double delivery_gauge(const double* y) const { return fluid_.gauge(fixed_ ? end_.s : y[n_]); }
  /// Whether the suction port has a pressure of its own.
  bool has_suction_volume() const { return suction_at_ > 0; }
  bool has_suction_line() const { return suction_line_.has_value(); }
  bool has_loop() const { return loop_; }
  bool has_accumulator() const { return accumulator_.has_value(); }
  /// Gauge pressure in the accumulator.
  double accumulator_gauge(const double* y) const { return fluid_.gauge(y[accumulator_at_]); }
  bool has_delivery_line() const { return pipe_.has_value(); }
  /// Gauge pressure in the suction port.
  double suction_gauge(const double* y) const {
    return fluid_.gauge(has_suction_volume() ? y[suction_at_] : tank_.s);
  }
  /// Place in the state of the air that is out, of chambers 1..N; 0: it is no state.
  int air_at() const { return air_at_; }
  /// Share of the dissolved air that is out in chamber k, from 0, at a state.
  double air_out(const double* y, int k) const {
    return air_at_ > 0 ? y[air_at_ + k] : fluid_.equilibrium(y[k]).value;
  }
  /// Oil of chamber k, from 0, at a state.
  Fluid::Mixture mixture(const double* y, int k) const {
    return air_at_ > 0 ? fluid_.mixture(y[k], y[air_at_ + k]) : Fluid::Mixture{fluid_.state(y[k])};
  }
  /// Gauge pressure in front of the load.
  double load_gauge(const double* y) const;
  /// Displacement x speed at the density in the tank, kg/s.
  double ideal_mass_flow() const;
  /// Size of the load that passes a mass flow at the delivery pressure asked for; or the given one.
  double load_size_for(double mass_flow) const;
  /// States with these pressures s in all chambers and on the delivery side, and a mass flow in the
  /// lines.
  std::vector<double> uniform(double chambers, double delivery, double mass_flow) const;
  /// Of a closed loop: gives one side the pressure of the other, chambers too.
  void exchange_sides(double* y) const;
  /// States at rest with these pressures s.
  std::vector<double> at_rest(const std::vector<double>& chambers, double delivery) const;
  /// Displacement of the pump, m3 per revolution.
  double displacement() const { return n_ * chamber_.swept(); }
  /// Whether a period turns the shaft backwards: x is what it has turned by, at -x it stands.
  bool backwards() const { return direction_ < 0; }
  /// Angle of chamber k, from 0, at x of a period.
  double angle_deg(double x, int k) const { return chamber_deg(direction_ * x, k); }
  /// The same where the block stands at an angle.
  double chamber_deg(double block_deg, int k) const { return block_deg - period_deg() * k; }
  /// Which chamber k, from 0, is after a period: it has come to where that one began.
  int next_of(int k) const { return (k + n_ - direction_) % n_; }
  /// Of each of states(): which one, at the end of a period, comes to its place.
  std::vector<int> order_after_period() const;

 private:
  // Places in the state where something of chambers 1..N begins.
  std::vector<int> by_chamber() const {
    return air_at_ > 0 ? std::vector<int>{0, air_at_} : std::vector<int>{0};
  }
  Load::Flow to_load(const double* y, const Fluid::State& line, const Fluid::State& source,
                     double load_size) const;
  Fluid::State source_of(const double* y) const;  // the suction port
  MassFlow charge_into(const Fluid::State& side) const;
  // The air that is out where oil comes from.
  struct Sources {
    Fluid::AirOut suction, delivery, outside;
  };
  Sources sources(const double* y) const;
  // d(air out)/dx of a chamber and its derivatives; `seconds` is dt/dx.
  struct AirRate {
    double value = 0, by_pressure = 0, by_air = 0, by_suction = 0, by_delivery = 0;
  };
  AirRate release(double s, double air_out) const;  // of its own, per s, and by s and air out
  struct ChamberFlows {
    MassFlow in, out, lost;  // from the suction port, into the delivery port, to the case
    double in_by_air = 0, out_by_air = 0, lost_by_air = 0;
  };
  ChamberFlows chamber_flows(double angle_deg, double volume, const Fluid::Mixture& at,
                             const Fluid::State& source, const Fluid::State& line) const;
  AirRate air_rate(double s, double air_out, const Fluid::Mixture& at, double volume,
                   const ChamberFlows& flows, const Sources& from, double seconds) const;
  Chamber::Volume volume(const Moment& now, int k) const;

  Use use_;
  int direction_;

  int n_;
  bool fixed_end_;  // the far end of the delivery side is held at a pressure
  Fluid fluid_;
  Chamber chamber_;
  PortOpening delivery_, suction_;
  double seconds_per_degree_, delivery_volume_, suction_volume_ = 0;
  Orifice orifice_;
  Leakage leakage_;
  // A pressure that is held: at the tank (or the charge supply) and at the end of the delivery
  // side.
  struct Held {
    Held(const Fluid& fluid, double pressure);
    double gauge, s;
    Fluid::State state;
    double potential;  // J/kg
  };
  double suction_s_, delivery_s_, suction_pressure_, delivery_pressure_, mean_scale_;
  Fluid::State suction_state_, fixed_state_, outside_;  // of the case: scales, what lines are about
  double case_potential_, fixed_potential_;             // J/kg
  Held tank_, end_;                                     // as they are now
  Load load_;
  std::optional<TransmissionLine> pipe_;
  std::optional<SuctionLine> suction_line_;
  std::optional<Accumulator> accumulator_;
  double inlet_area_ = 0, charge_area_ = 0, charge_opening_ = 0;
  bool loop_, fixed_, sought_;
  int suction_at_ = 0, pipe_at_ = 0, air_at_ = 0, accumulator_at_ = 0;  // places in the state
  int states_ = 0;
  double release_time_, dissolution_time_, case_s_;
  std::vector<double> edges_deg_;
};

}  // namespace bentaxis::hydraulics

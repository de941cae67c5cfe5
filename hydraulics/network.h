// The equations of the pump's hydraulic side: N chambers, two ports, lines, a load.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bentaxis/hydraulics/power.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/oil.h"
#include "chambers.h"
#include "element.h"
#include "fluid.h"
#include "load.h"
#include "orifice.h"
#include "port.h"
#include "system.h"

namespace bentaxis::hydraulics {

class DeliveryPipe;

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
  Network(const Network&) = delete;  // its elements refer to it
  Network& operator=(const Network&) = delete;
  ~Network();

  /// Of motion in time: the pressure in the tank, or of the charge supply, Pa gauge, instead of the
  /// case's; and that at which the delivery side is held. Scales of the states, volumes at suction
  /// density and what lines are linear about stay those of the case.
  void set_suction(std::optional<double> gauge);
  void set_delivery(std::optional<double> gauge);

  using Moment = hydraulics::Moment;
  using Flows = hydraulics::Flows;
  using Stored = hydraulics::Stored;
  /// At constant speed, per degree.
  Moment at(double x) const;
  /// Per second.
  static Moment at(const AxisMotion& shaft, const AxisMotion& block);

  int pistons() const { return chambers_->count(); }
  /// Whether the delivery port is held at a pressure, without a delivery volume in the state.
  bool fixed_line() const { return fixed_; }
  /// Whether the delivery side is held at a pressure, behind a delivery line or without.
  bool fixed_end() const { return fixed_end_; }
  /// Whether the size of the load is one more unknown, for which the mean delivery pressure is
  /// given.
  bool load_sought() const { return sought_; }
  const Load& load() const { return load_; }
  /// Pressures of chambers and delivery volume, the first of the state: N, or N + 1.
  int pressures() const { return fixed_ ? pistons() : pistons() + 1; }
  /// What comes back after a period, the first of the state: all but the mean.
  int states() const { return states_; }
  /// Name and meaning of each of the state, of motion in time.
  std::vector<OilColumn> state_columns() const;
  /// Length of the state.
  int size() const { return size_; }
  /// 360/N: after that angle every chamber stands where the one before it stood.
  double period_deg() const { return chambers_->apart_deg(); }
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
  Stored stored(const Moment& now, const double* y) const;
  /// The places that this circuit has, and of how many from the first on they are.
  std::vector<Place> places() const;
  int place_count() const;

  const Fluid& fluid() const { return fluid_; }
  const Chamber& chamber() const { return chambers_->one(); }
  const PortOpening& delivery() const { return chambers_->delivery(); }
  const PortOpening& suction() const { return chambers_->suction(); }
  double seconds_per_degree() const { return seconds_per_degree_; }
  double suction_log_pressure() const { return suction_.s; }
  double delivery_log_pressure() const { return delivery_.s; }  ///< of the mean asked for
  /// Of the high side as a search may begin: the one asked for; in a closed loop, which forgets too
  /// high a one by leakage alone, that at which a load of given size takes a share of the ideal
  /// flow.
  double expected_log_pressure(double share) const;
  double delivery_pressure() const { return delivery_.gauge; }
  /// What the mean in the state is a multiple of, Pa.
  double mean_scale() const { return mean_scale_; }
  /// Gauge pressure of the delivery volume, or of the fixed line.
  double delivery_gauge(const double* y) const {
    return fluid_.gauge(fixed_ ? end_.s : y[pistons()]);
  }
  /// Whether the suction port has a pressure of its own.
  bool has_suction_volume() const { return suction_at_ > 0; }
  bool has_loop() const { return loop_; }
  bool has_accumulator() const { return accumulator_at_ > 0; }
  /// Gauge pressure in the accumulator.
  double accumulator_gauge(const double* y) const { return fluid_.gauge(y[accumulator_at_]); }
  bool has_delivery_line() const { return pipe_ != nullptr; }
  /// Gauge pressure in the suction port.
  double suction_gauge(const double* y) const {
    return fluid_.gauge(has_suction_volume() ? y[suction_at_] : tank_.s);
  }
  /// Place in the state of the air that is out, of chambers 1..N; 0: it is no state.
  int air_at() const { return chambers_->air_at(); }
  /// Share of the dissolved air that is out in chamber k, from 0, at a state.
  double air_out(const double* y, int k) const {
    return air_at() > 0 ? y[air_at() + k] : fluid_.equilibrium(y[k]).value;
  }
  /// Oil of chamber k, from 0, at a state.
  Fluid::Mixture mixture(const double* y, int k) const { return chambers_->mixture(fluid_, y, k); }
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
  double displacement() const { return pistons() * chamber().swept(); }
  /// Whether a period turns the shaft backwards: x is what it has turned by, at -x it stands.
  bool backwards() const { return direction_ < 0; }
  /// Angle of chamber k, from 0, at x of a period.
  double angle_deg(double x, int k) const { return chambers_->angle_deg(direction_ * x, k); }
  /// The same where the block stands at an angle.
  double chamber_deg(double block_deg, int k) const { return chambers_->angle_deg(block_deg, k); }
  /// Which chamber k, from 0, is after a period: it has come to where that one began.
  int next_of(int k) const { return (k + pistons() - direction_) % pistons(); }
  /// Of each of states(): which one, at the end of a period, comes to its place.
  std::vector<int> order_after_period() const;

 private:
  // Elements in the order of their states.
  template <class E, class... Arguments>
  E* add(Arguments&&... arguments);
  void start(const StartOf& start, double* y) const;
  void connect(System& sys) const;
  void stamp(System& sys) const;

  int direction_;
  bool fixed_end_;  // the far end of the delivery side is held at a pressure
  Fluid fluid_;
  double seconds_per_degree_;
  Orifice orifice_;
  Held suction_, delivery_, outside_;  // of the case: scales, what lines are about
  Held tank_, end_;                    // what is held now
  double mean_scale_;
  Load load_;
  bool loop_, fixed_, sought_;
  std::vector<std::unique_ptr<Element>> elements_;
  Chambers* chambers_ = nullptr;
  const DeliveryPipe* pipe_ = nullptr;
  int suction_at_ = 0, accumulator_at_ = 0;  // places in the state
  int states_ = 0, size_ = 0;
  std::vector<double> edges_deg_;
};

}  // namespace bentaxis::hydraulics

// The circuit at one state: what its elements read, and what they stamp into it.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "bentaxis/results/instant.h"
#include "fluid.h"
#include "orifice.h"

namespace bentaxis::hydraulics {

/// Where elements meet.
enum Terminal {
  kTank,      ///< or the charge supply; its pressure is held
  kOutside,   ///< the atmosphere
  kSuction,   ///< the suction port: a volume, or held as in the tank
  kDelivery,  ///< the delivery port: a volume, or held
  kFarEnd,    ///< of the delivery line: its own pressure, or held
  kTerminals
};

/// A pressure that is held.
struct Held {
  Held(const Fluid& fluid, double pressure)
      : gauge(pressure),
        s(fluid.log_pressure(pressure)),
        oil(fluid.state(s)),
        potential(fluid.potential(s)) {}
  double gauge, s;
  Fluid::State oil;
  double potential;  // J/kg
};

/// Where shaft and block stand, and how they move while the states change.
struct Moment {
  double block_deg = 0;     ///< chambers meet the ports at the block's angle
  double seconds = 1;       ///< time per unit of what rates are by
  double turning = 1;       ///< what a volume's slope is times, for the same unit
  AxisMotion shaft, block;  ///< where they are not locked
  bool locked = true;       ///< both at block_deg, a volume's slope is by the angle
};

/// Mass flows at one state, kg/s; positive as named. And what they were found from.
struct Flows {
  std::vector<double> suction;      ///< from the suction port into each chamber
  std::vector<double> delivery;     ///< from each chamber into the delivery port
  std::vector<double> leakage;      ///< from each chamber to the case
  std::vector<Fluid::Mixture> oil;  ///< in each chamber
  std::vector<double> volume;       ///< of each chamber, m3
  double load = 0;                  ///< into the load; fixed line: all of the delivery
  double relief = 0;                ///< of that: over the relief valve beside the load
  double taken = 0;                 ///< from the tank, or from the charge supply
  double accumulator = 0;           ///< into the accumulator
  double power = 0;                 ///< of the pistons on the oil: -sum p dV/dt, W, p gauge
  double carried_in = 0;            ///< to the suction port, out of what is before it
  double carried_out = 0;           ///< from the delivery port, into what is behind it
};

/// Rates of the states, their derivatives and the flows, as far as they are wanted. Elements first
/// stamp the mass flows between terminals with their derivatives by the states there, as nodal
/// analysis of electrical circuits does; then volumes and lines turn what passes their terminals
/// into rates.
class System {
 public:
  struct Node {
    Side side{0, 0, 0, 0};
    double stiffness = 0, d_stiffness = 0, s = 0;  ///< K/P: of the side it is the density's
    int at = 0, states = 0;  ///< the states that move its pressure, alike each; none: held
    double potential = std::numeric_limits<double>::quiet_NaN();  ///< J/kg; NaN: not asked for yet
    double arrives = 0;   ///< kg/s: what the chambers, or a line that ends here, bring
    double leaves = 0;    ///< kg/s: into the elements of the circuit
    double by_size = 0;   ///< its derivative by ln(size of the load)
    double per_mass = 0;  ///< of a volume: what a mass flow changes its rate by
    bool is_state() const { return states > 0; }
  };

  System(const Fluid& the_fluid, const Moment& moment, const double* state, double size_of_load)
      : fluid(the_fluid), now(moment), y(state), load_size(size_of_load) {}

  const Fluid& fluid;
  const Moment& now;
  const double* y;
  double load_size;
  // What is null is not wanted. The Jacobian is column-major size x size.
  double* rates = nullptr;
  double* by_state = nullptr;
  double* by_load = nullptr;
  int size = 0;
  /// Asks for derivatives too.
  void want(double* state_derivatives, double* load_derivatives, int states) {
    by_state = state_derivatives;
    by_load = load_derivatives;
    size = states;
    leaves_by_ = {};
  }
  Flows* flows = nullptr;

  Node& operator[](Terminal t) { return nodes_[t]; }
  double& entry(int row, int column) const { return by_state[column * size + row]; }

  void hold(Terminal t, const Held& held) {
    set(t, held.oil, held.s);
    nodes_[t].potential = held.potential;
  }
  /// Its s = ln(P/P0) is the state at `at`.
  void free(Terminal t, int at) {
    set(t, fluid.state(y[at]), y[at]);
    nodes_[t].at = at;
    nodes_[t].states = 1;
    nodes_[t].potential = std::numeric_limits<double>::quiet_NaN();
  }
  /// Pressure potential, J/kg.
  double potential(Terminal t) {
    Node& node = nodes_[t];
    if (node.potential != node.potential) node.potential = fluid.potential(node.s);
    return node.potential;
  }

  /// A mass flow between two terminals, and its derivative by ln(size of the load).
  void flow(Terminal from, Terminal to, const MassFlow& flow, double by_size = 0) {
    nodes_[from].leaves += flow.value;
    nodes_[to].leaves -= flow.value;
    if (by_state == nullptr) return;
    nodes_[from].by_size += by_size;
    nodes_[to].by_size -= by_size;
    leaves_by_[from][from] += flow.by_first;
    leaves_by_[from][to] += flow.by_second;
    leaves_by_[to][from] -= flow.by_first;
    leaves_by_[to][to] -= flow.by_second;
  }
  /// What leaves a terminal, by the pressure there.
  double leaves_by_own(Terminal t) const { return leaves_by_[t][t]; }
  /// Of a row that follows what leaves a terminal: its derivatives by the states of all others.
  void stamp_others(Terminal t, int row, double factor) {
    if (by_load != nullptr) by_load[row] = factor * nodes_[t].by_size;
    for (int other = 0; other < kTerminals; ++other)
      for (int i = 0; i < nodes_[other].states && other != t; ++i)
        entry(row, nodes_[other].at + i) += factor * leaves_by_[t][other];
  }

 private:
  void set(Terminal t, const Fluid::State& oil, double s) {
    nodes_[t].side = oil;
    nodes_[t].stiffness = oil.stiffness;
    nodes_[t].d_stiffness = oil.d_stiffness;
    nodes_[t].s = s;
  }

  std::array<Node, kTerminals> nodes_;
  std::array<std::array<double, kTerminals>, kTerminals>
      leaves_by_;  // where derivatives are wanted
};

}  // namespace bentaxis::hydraulics

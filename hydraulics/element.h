// One element of the hydraulic circuit.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/hydraulics/power.h"
#include "bentaxis/results/oil.h"
#include "system.h"

namespace bentaxis::hydraulics {

/// States to begin with: s of the chambers and of both sides, and what the lines have.
struct StartOf {
  double chambers, suction, delivery;
  double delivery_pressure, mass_flow;  ///< Pa absolute, kg/s
};

/// What the circuit holds: with the power by place, d(energy)/dt is sources less all else.
struct Stored {
  double energy = 0, mass = 0;  ///< J, kg

  /// A volume of oil of a pressure.
  void add(double volume, double density, double potential, double gauge) {
    mass += volume * density;
    energy += volume * (density * potential - gauge);
  }
};

/// Everything that is to be said of it stands in one class: its states, the flows between its
/// terminals with their derivatives, the power it takes and what it holds.
class Element {
 public:
  explicit Element(int states) : states_(states) {}
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;
  virtual ~Element() = default;

  int states() const { return states_; }
  void begin_at(int at) { at_ = at; }  ///< its first state
  int at() const { return at_; }
  virtual void start(const StartOf&, double* /*y*/) const {}
  virtual void name_states(OilColumn* /*all*/) const {}

  /// Gives the terminals of its own their pressures.
  virtual void connect(System&) const {}
  virtual void stamp(System&) const {}
  /// After all flows are stamped: the rates of its states.
  virtual void finish(System&) const {}
  /// W by place, from the flows at the same state.
  virtual void power(System&, const Flows&, PowerBudget&) const {}
  virtual void stored(System&, Stored&) const {}
  /// Its places; of an option those alone that exist with it.
  virtual void places(std::vector<Place>& /*all*/) const {}

 private:
  int states_, at_ = 0;
};

}  // namespace bentaxis::hydraulics

// The pump of a unit: the closed form and its oil, under what comes from outside. Knows nothing of
// FMI's calls. Internal.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/surroundings.h"
#include "variables.h"

namespace bentaxis::fmu {

/// What inputs are, SI.
struct Inputs {
  double speed = 0, acceleration = 0;  ///< rad/s, rad/s2
  double torque = 0;                   ///< Nm
  double suction = 0, delivery = 0;    ///< Pa gauge
  double load_share = 1;
  bool load_share_replaces_curve = false;  ///< also where it is 1
  bool acceleration_given = false;  ///< by whoever sets inputs: else reactions lack inertia by it
  /// Per second, of what lies between two communication points of co-simulation.
  double torque_rate = 0, suction_rate = 0, delivery_rate = 0, load_share_rate = 0;

  bool operator==(const Inputs&) const = default;
};
/// The inputs so many seconds later, where nothing new is given.
void advance(Inputs& inputs, double seconds);
/// The rate of an input; null where it has none: the shaft's, whose speed has the acceleration.
double* rate_of(Inputs& inputs, Input which);
/// The number that an input is; of load_share_replaces_curve that of load_share.
double& input_of(Inputs& inputs, Input which);

/// A state of a unit that a run can go on from: everything but parameters.
struct PlantState {
  double time = 0;  ///< s, of the pump: FMI's less the start time
  std::vector<double> motion, oil;
  AxisMotion shaft;      ///< at that time, where its motion is an input
  double load_size = 0;  ///< that was found at the start
  /// What the start has made of the case, which scales the states: speed of [operation], rpm, and
  /// the ports' pressures, Pa gauge. Empty: those of the case.
  std::vector<double> started;
  bool speed_changed = false;
  Inputs inputs;
};

class Plant {
 public:
  enum class Kind { co_simulation, model_exchange };
  /// @param the_case  with its parameters as they are set
  /// @throws InputError where a case file that says the same would be refused
  Plant(const Case& the_case, const UnitChoice& choice, Kind kind);
  ~Plant();

  /// Start values of the inputs: those of the case.
  Inputs first_inputs() const;
  TakesFromOutside takes() const;

  /// Finds the start (of a hydraulic case that begins in its periodic state: that state). Long.
  /// @throws InputError, ComputationError
  /// @param end  s, at which it is expected to end; 0: after the duration that [drive] has, as
  ///             simulate does
  void start(const Inputs& inputs, double end = 0);
  /// Other numbers of the case while it runs: the state stays. Of tunable parameters.
  /// @throws InputError where a case file that says the same would be refused; all is then as it
  /// was
  void change(const Case& the_case);
  /// From the present time on.
  void set_inputs(const Inputs& inputs);
  const Inputs& inputs() const;
  double time() const;

  // Co-simulation.
  /// Goes on to a time, s. Inputs stay but for the speed, which changes by the acceleration. Steps
  /// of the integrator go on over communication points where inputs stay.
  /// @throws ComputationError where the motion cannot be followed; the plant then stands at time()
  void step(double time);
  /// The same to the end of the next step of the integrator or to the next event, where that comes
  /// before `time`.
  void step_towards(double time);
  /// Events of the last step: when, s (FMI's less the start time), and in words.
  struct Passed {
    double time = 0;
    std::string what;
  };
  std::vector<Passed> passed() const;

  // Model exchange: states, their rates and events for an integrator outside.
  std::size_t state_count() const;
  std::vector<double> states() const;
  const std::vector<double>& nominals() const;
  void set_time(double time);  ///< without a step
  void set_states(const std::vector<double>& states);
  void rates(std::vector<double>& rates);
  std::size_t indicator_count() const;
  /// Positive and negative values are the sides; of edges of the ports, of touches of flanks, of
  /// anything where the rates have a kink.
  void indicators(std::vector<double>& values);
  struct Event {
    bool states_changed = false;
    std::optional<double> next_time;  ///< s, of a breakpoint of a curve
  };
  /// Enters what lies beyond the events at the present time.
  Event pass_event();
  /// Whether a step that has ended should be an event (a breakpoint has been reached, a hidden
  /// touch).
  bool wants_event();
  /// d(unknown)/d(known) seed, where both are states, derivatives, continuous inputs or outputs; by
  /// roles and places of `variables`.
  /// @param known_seed  one per known
  std::vector<double> directional_derivative(const std::vector<const Variable*>& unknowns,
                                             const std::vector<const Variable*>& knowns,
                                             const std::vector<double>& known_seed);

  // Both.
  /// At the present time: the columns of `simulate`'s tables in their order and units, those of
  /// simulation_analytic.csv but time_s, then of oil_analytic.csv but time_s.
  const std::vector<double>& outputs();
  /// In the order of columns_of().
  const std::vector<bool>& flags();

  PlantState state() const;
  void set_state(const PlantState& state);

 private:
  class Implementation;
  std::unique_ptr<Implementation> it_;
};

/// Names and units of Plant::outputs(), of states and of flags, before a plant is there.
struct PlantColumn {
  std::string name, unit, description;
  double nominal = 1;
};
struct PlantColumns {
  std::vector<PlantColumn> outputs, flags, states, indicators;
};
PlantColumns columns_of(const Case& the_case, const UnitChoice& choice);

}  // namespace bentaxis::fmu

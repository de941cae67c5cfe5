// Motion and oil as states, rates and events, for an integrator outside.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/coupled/system_state.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/results/surroundings.h"

namespace bentaxis::coupled {

class PortEdges;

/// A state that the integrator carries.
struct OpenState {
  std::string name;     ///< "shaft_angle"
  std::string unit;     ///< of the state, "rad"; of its rate it is that per second
  std::string meaning;  ///< in words
  double nominal = 1;   ///< what an error is measured by
};

/// A quantity whose passing of zero is an event.
struct OpenIndicator {
  std::string name, unit, meaning;
};

/// The equations of Stepper without a solver: angles and speeds of shaft, teeth and coupling as far
/// as they move, then the states of the oil. Where the shaft's motion comes from outside its angle
/// is a state. Works and impulses are none.
class OpenSystem {
 public:
  /// @param shaft_from_outside  whether set_inputs() gives the shaft's motion
  OpenSystem(Mechanics& mechanics, Oil& oil, bool shaft_from_outside);
  ~OpenSystem();

  const std::vector<OpenState>& states() const { return states_; }
  const std::vector<OpenIndicator>& indicators() const { return indicators_; }

  /// Stands at a time, s, with a state; enters the interval between edges that it lies in.
  void start(double time, const SystemState& state);
  /// From now on these act from outside; of the shaft its speed and acceleration: its angle is a
  /// state.
  void set_inputs(const Surroundings& outside);
  [[deprecated("use set_inputs")]] void surround(const Surroundings& outside) {
    set_inputs(outside);
  }

  void set_time(double time);
  double time() const { return time_; }
  void set(const std::vector<double>& values);
  std::vector<double> values() const;
  const SystemState& state() const { return state_; }

  /// d(values)/dt. @return false where a value is not finite
  bool rates(std::vector<double>& rates);
  /// Positive between the edges; of a contact its approach, m.
  void indicator_values(std::vector<double>& values) const;
  /// The edges on both sides of the block, rad, are anew those around where it stands.
  void pass_event();
  /// Whether the block has left the interval between edges.
  bool beyond() const;
  /// The next time at which a law changes, s.
  std::optional<double> next_breakpoint() const;
  [[deprecated("use next_breakpoint")]] std::optional<double> next_knot() const {
    return next_breakpoint();
  }

 private:
  AxisMotion block() const { return mechanics_.block(time_, state_.motion); }
  void tell_mechanics();

  Mechanics& mechanics_;
  Oil& oil_;
  std::vector<OpenState> states_;
  std::vector<OpenIndicator> indicators_;
  std::vector<std::size_t> active_;  // of the states of motion
  std::vector<double> breakpoints_;
  std::vector<int> contacts_;
  std::unique_ptr<PortEdges> edges_;
  Surroundings outside_;
  bool angle_is_state_;
  double start_speed_ = 0;       // that kTurn and kTurnRate are relative to
  double time_ = 0, angle_ = 0;  // of the shaft, where it is a state
  SystemState state_;
  OilLoads loads_;
  std::vector<double> oil_rates_;
};

}  // namespace bentaxis::coupled

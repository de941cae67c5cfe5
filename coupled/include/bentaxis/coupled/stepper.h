// Motion and oil from one communication point to the next, under what comes from outside.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bentaxis/coupled/system_state.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/results/surroundings.h"

namespace bentaxis::coupled {

/// What happened in a step.
struct PassedEvent {
  enum class Kind {
    edge,        ///< the block has passed an edge of a port
    touch,       ///< a flank of the teeth, or a piston and its wall, has begun to touch
    release,     ///< it has left the other
    breakpoint,  ///< a law over time has changed
    knot [[deprecated("use breakpoint")]] = breakpoint
  };
  Kind kind = Kind::edge;
  double time = 0;   ///< s
  double angle = 0;  ///< of an edge: rad, of the block
  int flank = 1;     ///< of a touch and a release: +1, -1
  int piston = 0;    ///< of those of walls: 1..N; 0: teeth
};

/// Follows motion and oil as simulate() does. Steps of the integrator go on over communication
/// points and are read there by its own polynomial, so that without changes the result is
/// simulate()'s, however many points there are; what changes at a point starts it anew from the
/// state there.
class Stepper {
 public:
  /// @param name       of the model, for messages
  /// @param tolerance  error per step of each state, of its scale
  Stepper(std::string name, Mechanics& mechanics, Oil& oil, double tolerance);
  ~Stepper();

  /// Begins at a time, s, with a state.
  /// @param end  s, at which it is expected to end: no step goes beyond it before it is reached.
  ///             Where it goes on after that, it is expected to for as long again.
  void start(double time, const SystemState& state, double end);
  /// Anew from time() on: after what the mechanics or the oil are has been changed.
  void restart();
  /// From time() on these act from outside; nothing is done where they do so already.
  /// @throws InputError where the drive does not take them
  void set_inputs(const Surroundings& outside);
  [[deprecated("use set_inputs")]] void surround(const Surroundings& outside) {
    set_inputs(outside);
  }
  const Surroundings& surroundings() const;

  /// @throws ComputationError naming the time where the motion cannot be followed; time() and
  /// state()
  ///         are then what they were
  void step_to(double time);
  /// The same to the end of the next step of the integrator, where that comes before `time`. An
  /// event ends such a step: those of passed() are then at time().
  void step_towards(double time);
  /// Events of the last step_to() or step_towards(), up to time(), in their order.
  std::vector<PassedEvent> passed() const;
  double time() const;
  const SystemState& state() const;
  long steps() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> it_;
};

}  // namespace bentaxis::coupled

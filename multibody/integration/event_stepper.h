// Steps of an integrator that end where the equations of motion change.
#pragma once

#include <SimTKsimbody.h>

#include <functional>
#include <memory>
#include <vector>

#include "bentaxis/multibody/integrated.h"

namespace bentaxis::multibody {

/// What tells that the equations of motion change: a value that rises through 0. Until then forces
/// follow the branch that held before, also a little beyond.
struct Witness {
  std::function<double(const SimTK::State&)> value;  ///< state realized to Velocity
  std::function<double(const SimTK::State&)> rate;   ///< of the value; empty: not known
  double tolerance = 0;                              ///< a value this near to 0 is 0
};

/// Carries a state through time. A step in which a witness rises through 0 is done again, shorter,
/// until it ends there: no step crosses a kink of the forces, and none is interpolated.
class EventStepper {
 public:
  /// @param system      outlives the stepper
  /// @param most_steps  after which it gives up
  EventStepper(const SimTK::MultibodySystem& system, const IntegrationOptions& options,
               long most_steps);

  /// Begins at a state, under the forces as they are now.
  void start(const SimTK::State& state);
  /// Goes on after the forces have changed.
  void restart();

  /// Steps to `time`, or to where the first witness rises through 0.
  /// @return the witness, or -1 where `time` was reached
  /// @throws ComputationError where the integrator gives up, or the steps are used up or would be
  int advance(double time, const std::vector<Witness>& witnesses);

  const SimTK::State& state() const { return integrator_->getState(); }
  double time() const { return integrator_->getTime(); }
  long steps() const { return steps_; }
  /// Time that is to be simulated in all, s: the steps it would take are foreseen from it.
  void foresee(double duration) { duration_ = duration; }
  /// Called at every step. May throw.
  std::function<void()> alive = [] {};

 private:
  struct Point {
    double time = 0;
    SimTK::Vector variables;
  };
  Point here() const { return {time(), integrator_->getState().getY()}; }
  void go_back(const Point& point, double step);
  bool step_once(double time);
  void step_to(double time);
  int first_risen(const std::vector<Witness>& witnesses) const;
  bool turned_back_beyond(const Witness& witness, const Point& from, double value, double rate);
  int land(int risen, Point from, const std::vector<Witness>& witnesses);

  const SimTK::MultibodySystem& system_;
  std::unique_ptr<SimTK::Integrator> integrator_;
  long most_steps_, steps_ = 0;
  double duration_ = 0;
  double usual_step_;  // s, that no event or report cut short
  SimTK::State scratch_;
};

}  // namespace bentaxis::multibody

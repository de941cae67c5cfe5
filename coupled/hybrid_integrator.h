// Follows motion and oil through edges of the ports, breakpoints of curves and touches of the
// teeth. Internal.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/results/trajectory.h"
#include "port_edges.h"
#include "system.h"

namespace bentaxis::coupled {

class HybridIntegrator {
 public:
  /// @param name      of the model, for messages
  /// @param balances  as for System
  HybridIntegrator(std::string name, Mechanics& mechanics, const Oil& oil, double tolerance,
                   bool balances);

  void start(double time, const SystemState& state);
  /// One step, to `end` at most. What happens at its end is taken account of by the next one, so
  /// that everything between is still to be had from state_at().
  /// @throws ComputationError naming the time
  void advance(double end);
  /// Takes the last step back to a time within it, as if it had ended there: what acts from outside
  /// changes then.
  void go_back(double time);
  /// To a state that jumps at time(): of integrals of it, what is not the motion's own.
  void jump(const SystemState& state) { state_ = state; }
  double time() const { return time_; }

  /// At a time of the last step.
  void state_at(double time, SystemState& state) const;
  void integrals_at(double time, std::vector<double>& integrals) const;  ///< SI
  /// The time of the last step at which the block has got to an angle between those at its ends.
  double time_at(double block_angle) const;

  /// Time that is to be simulated in all, s: the steps it would take are foreseen from it.
  void foresee(double duration) { duration_ = duration; }
  /// Flanks that touch have their impulse until now. That of a wall is not told from the others'.
  void close_contacts();
  const std::vector<ToothEvent>& events() const { return events_; }
  /// Of the last step: the edge of a port that the block has passed at time(), rad, and whether a
  /// law changes there (a breakpoint of a curve).
  std::optional<double> passed_edge() const { return passed_edge_; }
  bool at_breakpoint() const { return at_breakpoint_; }
  /// They are not kept any longer, nor are steps counted until now: of a motion without an end.
  void forget_events();
  double time_apart() const { return apart_; }  ///< s, without touch of any contact
  long steps() const { return integrator_.steps(); }
  long evaluations() const { return system_.evaluations(); }
  const System& system() const { return system_; }
  AxisMotion shaft(double time, const SystemState& s) const {
    return system_.mechanics().shaft(time, s.motion);
  }
  AxisMotion block(double time, const SystemState& s) const {
    return system_.mechanics().block(time, s.motion);
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Touching {
    bool now = false;
    std::size_t event = kNone;  // of its touch
    double impulse = 0;         // then
  };

  // What a step changes beside the states.
  struct Memory {
    std::vector<Touching> touching;
    std::size_t events = 0;
    double apart = 0;
  };

  [[noreturn]] void fail(const std::string& why) const;
  void set_interval();
  void start_contacts();
  const std::vector<int>& contacts() const { return system_.contacts(); }
  bool touching() const;
  void contact_changes(std::size_t contact, bool touch);
  void close_contact(Touching& of);
  void read_integrals(double time, std::vector<double>& integrals) const;  // scaled
  bool hidden_touch();
  bool hides_touch(std::size_t contact);
  double horizon(double end) const;
  void keep_going();

  double duration_ = 0;
  std::string name_;
  System system_;
  numerics::StiffIntegrator integrator_;
  PortEdges edges_;
  std::vector<double> breakpoints_;
  bool has_oil_;
  bool restart_ = false;  // before the next step
  std::optional<double> passed_edge_;
  bool at_breakpoint_ = false;
  double time_ = 0, step_start_ = 0, apart_ = 0;
  SystemState state_;  // at time_
  std::vector<double> y_, integrals_;
  std::vector<Touching> touching_;  // by contact
  std::vector<ToothEvent> events_;
  Memory before_;  // the last step
  int short_steps_ = 0;
  long forgotten_steps_ = 0;
  mutable SystemState sampled_;
};

}  // namespace bentaxis::coupled

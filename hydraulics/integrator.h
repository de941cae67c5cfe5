// Time integration of the network over one period.
#pragma once

#include <functional>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/error.h"
#include "network.h"

namespace bentaxis::hydraulics {

/// Integrals over the angles of a period; masses in kg, work in J.
struct Integrals {
  double suction = 0, delivery = 0, leakage = 0, load = 0;
  double work = 0;  ///< of the pistons on the oil, gauge pressure
  /// What flows for some seconds.
  void add(const Flows& flows, double seconds);
};

/// Of a summary what integrals over a period say: displacement, density, flows, masses and work.
void summarize(const Network& network, const Integrals& over_period, Summary& summary);

/// The integration does not get through the period from here; from elsewhere it may.
class IntegrationFailure : public ComputationError {
 public:
  using ComputationError::ComputationError;
};

/// What an integration cost.
struct Work {
  long steps = 0, evaluations = 0;
};

/// A way in the space of parameters: the equations a little before and after on it.
struct Direction {
  const Network* above;
  const Network* below;
  double above_load, below_load;  ///< sizes of their loads
  double apart;                   ///< of the two on the way
};

/// Carries states through one period of 360/N degrees. Restarts at every port edge. Uses the
/// network's own Jacobian, and forward sensitivities.
class Integrator {
 public:
  /// @param alive  called now and then; may throw
  explicit Integrator(const Network& network, std::function<void()> alive = {});

  /// What the integration knows of one of its steps.
  struct Step {
    double from = 0, to = 0;  ///< degrees of the period
    bool at_edge = false;     ///< it ends at a port edge or at the end of the period
    /// State at an angle of the step, by the integrator's own polynomial; until the next call.
    std::function<const double*(double x)> state;
    /// Integrals from the start of the period, where they were asked for.
    std::function<Integrals(double x)> integrals;
    /// Sensitivities at an angle of the step, where they were asked for, as over_period gives them;
    /// until the next call.
    std::function<const std::vector<double>&(double x)> sensitivities;
  };
  using Watch = std::function<void(const Step& step)>;

  /// State at the end of the period from the state at its start (Network::states(); the mean starts
  /// at 0).
  /// @param tolerance    error of s (so relative error of P) allowed per step
  /// @param sensitivity  if not null: receives d(end state)/d(start states, ln load_size),
  ///                     column-major, size() rows; the last column only where it is sought
  /// @param integrals    if not null: receives the integrals, with the same control of error
  /// @param watch        called after every step
  /// @param energy       if not null: receives the energy that has gone by each place, J, in place
  ///                     of `integrals`, with the same control of error
  /// @throws IntegrationFailure naming the angle where the integration fails
  /// @throws ComputationError where all integrations so far have taken more steps than any pump
  ///         needs
  std::vector<double> over_period(const std::vector<double>& states, double load_size,
                                  double tolerance, std::vector<double>* sensitivity = nullptr,
                                  Integrals* integrals = nullptr, const Watch& watch = {},
                                  PowerBudget* energy = nullptr);

  /// From now on sensitivities have a column more for each direction, of states that start as they
  /// are, and all columns are integrated with control of their own error: `tolerance` of a column
  /// and, absolute, of d(state)/d(way).
  void follow(std::vector<Direction> directions, double tolerance);

  const Work& work() const { return work_; }  ///< of all calls so far
  /// Of the effort after which every call fails, what is gone.
  double share_of_effort() const;
  void spend_at_most(double share) { most_ = share; }

 private:
  const Network& network_;
  std::function<void()> alive_;
  std::vector<Direction> directions_;
  double directions_tolerance_ = 0;
  Work work_;
  double effort_ = 0;  // of all calls so far
  double most_ = 1;    // of the effort allowed
  double since_sign_ = 0;
};

}  // namespace bentaxis::hydraulics

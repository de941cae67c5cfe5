// A case's motion in time by both models, and what their difference means.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/results/trajectory.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

struct SimulationChoice {
  std::optional<Model> only;       ///< none: both, compared
  double error = 1e-6;             ///< of every reaction, of its peak: wanted and tolerated
  std::optional<double> accuracy;  ///< of Simbody's steps instead of one found for `error`
  multibody::Integrator integrator = multibody::Integrator::runge_kutta_merson;
};

/// How far apart the models are in a group of channels, over its peak.
struct GroupDifference {
  std::string group, unit;
  double peak = 0;
  double in_time = 0, time_s = 0;  ///< at equal times, largest, and when
  double over_angle = 0;           ///< at equal shaft angles
  double of_allowed = 0;  ///< largest difference in time over what is allowed then: 1 is the limit
};

/// Touches of both models that belong together.
struct EventMatch {
  std::size_t touches[2] = {0, 0};  ///< of each model
  std::size_t matched = 0;
  double time_s = 0;   ///< largest difference in time of matched ones
  double impulse = 0;  ///< likewise of their impulse, over the largest impulse
  double mean_impulse[2] = {0, 0}, largest_impulse[2] = {0, 0};  ///< Ns per touch
};

/// What a run cost and how far from the truth it was.
struct Effort {
  Model model;
  std::string method;
  double asked = 0;  ///< error asked of the analytic model; accuracy per step of Simbody
  double error = 0;  ///< largest of any reaction, of peak, within the judged time
  double seconds = 0;
  long steps = 0, evaluations = 0;
};

struct SimulationResult {
  ReadyCase ready;
  SimulationChoice choice;
  std::optional<Trajectory> analytic, multibody;

  // With the analytic model: how much a disturbance of the start grows.
  double disturbance = 0;
  std::vector<double> growth;  ///< per row: largest so far, of any reaction, of peak, over the
                               ///< disturbance; at least 1
  double judged_until_s = 0;   ///< later a disturbance of `error` would change results altogether

  // With both:
  std::vector<GroupDifference> groups;
  std::vector<double> difference;  ///< per row: largest of any reaction, of peak
  double speed_difference = 0;     ///< of the shaft, of its largest speed
  double lag_difference = 0;       ///< of theta - psi, rad
  EventMatch events;
  std::vector<compare::Check> checks;
  std::vector<Effort> effort;
  std::string multibody_choice;  ///< how Simbody's accuracy was found

  /// Allowed difference at a row, of peak: the wanted error, grown as disturbances grow.
  double allowed(std::size_t row) const { return choice.error * growth[row]; }
  const GroupDifference* worst() const;  ///< nearest to or furthest beyond what is allowed
  /// Time that a model needs for an error, between its efforts; not_computed() where none of them
  /// reached it.
  double seconds_for(Model model, double error) const;
  bool agrees() const;  ///< of one model alone: its checks hold
  std::string headline() const;
};

/// Simulates a case that is ready by one model or both.
/// @throws InputError, ComputationError
SimulationResult simulate(ReadyCase ready, const SimulationChoice& choice,
                          const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

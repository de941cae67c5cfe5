// A case's motion in time by both models, and what their difference means.
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/trajectory.h"
#include "bentaxis/study/fmu_coupling.h"
#include "bentaxis/study/motion_answers.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// What the chambers' pressures are in a simulation of a hydraulic case.
enum class OilInTime {
  follows,   ///< states of their own, integrated with the motion
  periodic,  ///< the periodic ones of the speed of [operation], over the block's angle: the same
             ///< curve for both models
};

/// In which coordinates the multibody model is integrated, where pressures are given.
enum class Coordinates {
  constraints,  ///< of every body, by Simbody; its constraint equations hold pump and pistons
                ///< together, as in the paper's virtual pump
  independent,  ///< of what can move by itself: shaft, block, rotor. Simbody's constraint equations
                ///< give the pistons at every evaluation
};

/// Names as on the command line, in the order of the enumeration.
const std::vector<std::string>& coordinates_names();

struct SimulationChoice {
  OilInTime oil = OilInTime::follows;        ///< of hydraulic cases
  bool steady = false;                       ///< the periodic motion instead of that from the start
  std::optional<Model> only;                 ///< none: both, compared
  std::shared_ptr<const UnitCoupling> unit;  ///< that acts on the pump; none: the case alone says
  double error = 1e-6;             ///< of every reaction, of its peak: wanted and tolerated
  std::optional<double> accuracy;  ///< of the multibody model's steps; none: found for `error`
  multibody::Integrator integrator = multibody::Integrator::runge_kutta_merson;
  /// None: see coordinates_of(). Of no effect where one method integrates both models.
  std::optional<Coordinates> coordinates;
};

/// How far apart the models are in a group of channels, over its scale.
struct GroupDifference {
  std::string group, unit;
  double peak = 0;
  double in_time = 0, time_s = 0;  ///< at equal times, largest, and when
  double over_angle = 0;           ///< at equal shaft angles
  bool judged = true;              ///< flows are not
  /// Largest difference in time over what is allowed then: 1 is the limit; not_computed() of what
  /// has no verdict, and where a value is missing or not finite: then the models do not agree.
  double of_allowed = 0;
  /// What differences are over: the peak, at least compare::kMinScale of the loads of the run.
  double scale = 0;
  double allowed_s = 0;  ///< when that largest difference over what is allowed is
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
  double error = 0;  ///< largest of any reaction, of peak, within the compared time
  double seconds = 0;
  long steps = 0, evaluations = 0;
};

/// By how much results change at half the communication step, in a group of channels.
struct CouplingChange {
  std::string group, unit;
  double peak = 0;
  double change = 0, time_s = 0;  ///< of peak, largest, and when
  /// Of the results shown: values stand from one communication point to the next, so that the error
  /// falls as the step does, and twice the change is left.
  double error() const { return 2 * change; }
};

/// A periodic motion: of an N-th of a turn.
struct PeriodicMotion {
  double period_s = 0;
  double speed = 0;  ///< rad/s, mean
  int iterations = 0;
  double error = 0;                               ///< how far a state is off, of its scale
  std::vector<std::complex<double>> multipliers;  ///< Floquet's, largest magnitude first
  bool stable() const;
};

/// What is asked for; else constraints where accuracy or integrator are, or where dry friction
/// jumps, and independent coordinates elsewhere.
Coordinates coordinates_of(const SimulationChoice& choice, const Case& the_case);

struct SimulationResult {
  PreparedCase ready;
  SimulationChoice choice;
  bool oil_follows = false;                   ///< the oil is simulated too
  std::optional<PeriodicMotion> periodic[2];  ///< by model, where it was asked for
  /// Of a simulation with oil: largest change of any reaction or pressure of the analytic model, of
  /// peak, at a tolerance ten times looser; not_computed() elsewhere.
  double integration_change = not_computed();
  std::optional<Trajectory> analytic, multibody;
  /// Of the first of them: where both agree, those of the other are the same.
  MotionAnswers answers;

  // With the analytic model: how much a disturbance of the start grows.
  double disturbance = 0;
  std::vector<double> growth;  ///< per row: largest so far, of any reaction, of peak, over the
                               ///< disturbance; at least 1
  double judged_until_s = 0;   ///< later a disturbance of `error` would change results altogether

  // With both:
  std::vector<GroupDifference> groups;
  std::vector<double> difference;  ///< per row: largest of any reaction, of peak; not_computed() of
                                   ///< rows_at_steps
  /// In the compared time: rows at which the integration errors of the models leave them on
  /// different sides of a step of the pressure. They are not compared.
  std::size_t rows_at_steps = 0;
  double speed_difference = 0;  ///< of the shaft, of its largest speed
  double lag_difference = 0;    ///< of theta - psi, rad
  EventMatch events;
  std::vector<compare::Check> checks;
  std::vector<Effort> effort;
  std::shared_ptr<UnitRecord> exchanged[2];  ///< by model, with an FMU
  std::vector<CouplingChange> coupling;      ///< with an FMU, in the compared time, largest first
  std::string multibody_choice;              ///< how Simbody's accuracy was found

  /// Allowed difference at a row, of peak: the wanted error times the amplification of
  /// disturbances.
  double allowed(std::size_t row) const { return choice.error * growth[row]; }
  const GroupDifference* worst() const;    ///< largest difference over its tolerance
  const GroupDifference* largest() const;  ///< largest difference in time of what is judged
  /// Time that a model needs for an error, between its efforts; not_computed() where none of them
  /// reached it.
  double seconds_for(Model model, double error) const;
  bool has_teeth() const { return ready.the_case.pump.gear.contact == ToothContact::teeth; }
  bool agrees() const;  ///< of one model alone: its checks hold
  std::string headline() const;
};

/// Makes a case ready for simulate(): as prepare(), but where the oil follows the motion the
/// periodic pressure is only computed where the load's size or the start come from it.
/// @throws InputError where `choice` says something that has no effect
PreparedCase prepare_simulation(Case the_case, const SimulationChoice& choice,
                                const PartProgress& progress_of = silent());

/// Simulates a case that is ready by one model or both.
/// @throws InputError, ComputationError
SimulationResult simulate(PreparedCase ready, const SimulationChoice& choice,
                          const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

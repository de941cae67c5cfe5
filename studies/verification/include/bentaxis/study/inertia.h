// What treating a piston as two point masses does to the reactions (Roccatello & Nervegna 2009,
// appendix, Fig. 36 and 37): for a case's own piston, speed and load, by both models.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "bentaxis/compare/difference.h"
#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// The case with nothing but inertia acting: pressures, weight, spring and friction off, as in the
/// paper's appendix.
Case without_loads(Case the_case);
Case at_speed(Case the_case, double speed_rpm);

/// One run of both kinds of piston by both models, which assume the same otherwise: what the case
/// gives the analytic model.
struct InertiaRun {
  double speed_rpm = 0;
  bool loaded = false;
  ResultTable analytic_lumped, analytic_real;
  ResultTable multibody_lumped, multibody_real;  ///< of the scene asked for
  /// Pistons whose multibody table is by inverse dynamics, because they have no inertia about A and
  /// so no equation of motion; all others are by constraint multipliers.
  std::vector<PistonInertia> by_inverse_dynamics;
  double joint_circle_radius = 0;  ///< m
};
/// @throws InputError where the case has no data of the real piston or the speed is 0
/// @throws ComputationError where a model refuses the case
InertiaRun run_both_pistons(const Case& the_case, double speed_rpm, bool loaded,
                            multibody::Scene scene, const Progress& progress = {});

/// Share of the loads below which a reaction is a remainder of loads that cancel: less than what
/// radii and angles of a drawing are known to by orders.
inline constexpr double kRemainder = 1e-6;

/// What lumping changes in one reaction: largest magnitude of the vector lumped - real over turn
/// and pistons, in the reaction's unit.
struct LumpingError {
  std::string group, unit;
  double speed_rpm = 0;
  bool loaded = false;
  double analytic = 0, multibody = 0;
  double peak = 0;         ///< of the real piston's reaction in this run
  double loaded_peak = 0;  ///< of the real piston's loaded reaction at this speed
  double loads = 0;        ///< in the same unit: the largest force of a piston, or its moment at Ra

  /// The loads of the pistons cancel in this reaction: it and the error are what is left of them,
  /// below kRemainder, and no effect of inertia that matters.
  bool cancels() const { return std::max(analytic, loaded_peak) <= kRemainder * loads; }
  double fraction() const { return loaded_peak > 0 && !cancels() ? analytic / loaded_peak : 0; }
};
/// Errors of all groups of reactions of a run. `loaded` gives the scale; may be `run` itself.
std::vector<LumpingError> lumping_errors(const InertiaRun& run, const InertiaRun& loaded);

/// first - second, channel by channel; not computed where either is not.
ResultTable difference(const ResultTable& first, const ResultTable& second,
                       const std::string& name);
/// Largest difference of any reaction, held to its group's peak. Without load the pistons' inertia
/// forces cancel in many sums: no peak counts as smaller than `force` (N) or that force at `radius`
/// (Nm).
/// @param computed  which reactions must have a value in both tables; the others are left out
compare::Difference largest_difference(const ResultTable& first, const ResultTable& second,
                                       const std::function<bool(const Channel&)>& computed,
                                       double force, double radius);
[[deprecated("use largest_difference")]] inline double largest_over_peak(const ResultTable& first,
                                                                         const ResultTable& second,
                                                                         double force,
                                                                         double radius) {
  const auto all = [](const Channel&) { return true; };
  return largest_difference(first, second, all, force, radius).share();
}

/// The lumping error of piston 1 without load, switched on one cause at a time. From a lumped
/// piston to the real one the centre of mass, the transverse inertia and the spin change; reactions
/// are linear in m s_G, It + m s_G^2 and Ia w_s, so the three parts add up exactly.
struct ErrorCauses {
  ResultTable centre, transverse, spin;  ///< lumped - real, this cause alone
  ResultTable all;
  double rest = 0;  ///< largest of all - (centre + transverse + spin), N
};
enum class By { analytic, multibody };
ErrorCauses causes_of_error(const Case& the_case, double speed_rpm, By model);

/// Error left by a way of lumping, without load, largest over the turn, N.
struct Lumping {
  std::string name;
  double joint_mass_fraction = 0;  ///< chi; not_computed() for three masses
  double error_rs = 0, error_rc = 0;
};
/// The case's own chi, chi = 1 - s_G / b1 (keeps the centre of mass), the chi in [0, 1] that leaves
/// least in Rs and in Rc, and three point masses. By the analytic model.
std::vector<Lumping> lumpings(const Case& the_case, double speed_rpm);
/// Errors over chi, for a plot.
std::vector<Lumping> lumping_over_fraction(const Case& the_case, double speed_rpm, int points);

/// Point masses at A, at the centre of mass and at B that have the real piston's mass, centre and
/// transverse inertia.
struct ThreeMasses {
  double at_joint = 0, at_centre = 0, at_ring = 0;  ///< kg
  bool exists = false;    ///< the centre of mass is strictly between A and B, or It = 0
  bool positive = false;  ///< no mass is below 0: three real masses would do
};
ThreeMasses three_masses(const PumpParameters& pump);

/// What grows along the map.
enum class MapAxis {
  mass,    ///< mass and inertias of the piston by the same factor
  length,  ///< piston length and centre of mass by the factor, mass and axial inertia too,
           ///< transverse inertia by its cube: a rod of the same cross-section
};

/// Lumping error over the loaded reaction of the same pump, by speed and factor.
struct ErrorMap {
  MapAxis axis = MapAxis::mass;
  std::vector<double> speed_rpm, factor;
  /// By factor, then speed; not_computed() where the pump cannot be assembled.
  std::vector<std::vector<double>> rs, rc;
};
ErrorMap error_map(const Case& the_case, MapAxis axis, std::vector<double> speeds,
                   std::vector<double> factors, const Progress& progress = {});

/// The real piston made gradually a lumped one (t from 1 to 0), in Simbody: how far its reactions
/// are from the lumped scene's, N.
struct Approach {
  double t = 0;
  double error_rs = 0, error_rc = 0;
};
std::vector<Approach> approach_to_lumped(const Case& the_case, double speed_rpm);

/// A real, spinning piston in a pump integrated over a turn: how well its spin stays.
struct SpinRun {
  double spin_rpm = 0;      ///< at the start
  double worst_change = 0;  ///< rad/s, of any piston
  double accuracy = 0;
};
SpinRun spin_run(const Case& the_case, double speed_rpm, double spin_rpm,
                 const Progress& progress = {});

/// Size of a scene and what an angle costs in it: processor time, measured over a turn.
struct SceneCost {
  std::string scene, method;
  int bodies = 0, mobilities = 0, equations = 0;
  double microseconds_per_angle = 0;
};
/// All scenes and methods, in one run, real pistons.
std::vector<SceneCost> scene_costs(const Case& the_case);

}  // namespace bentaxis::study

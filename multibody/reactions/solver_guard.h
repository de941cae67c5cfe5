// How far Simbody's constraint multipliers can be trusted at one state.
//
// Simbody solves G M^-1 G^T lambda = right side and drops directions in which that matrix is
// singular to round-off, without a word. It is so where bodies of very different mass meet, or
// where constraints are almost dependent.
#pragma once

#include <functional>
#include <string>

#include "reactions/reactions.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// Estimated error of the constraint forces at any state, over the largest of them; NaN where
/// Simbody's solution is not finite.
///
/// What the solver drops shows as accelerations that violate the
/// constraints: G udot is off by e = getUDotErr(). Accelerations that would not be off differ from
/// Simbody's by du with G du = e, and equilibrium with them needs other multipliers:
/// G^T dlambda = M du. No second model and no tolerance of the solver enters.
/// @param state  dynamics state realized to Acceleration
double estimated_force_error(const PumpSystem& pump, const SimTK::State& state);

/// Largest difference between the forces of two solutions of the same state over the largest force;
/// torques of the drive and of an imposed block count as forces at the joint circle. NaN where
/// either is not finite.
double force_difference(const PumpSystem& pump, const Reactions& reactions,
                        const Reactions& others);

/// Refuses multipliers that have lost more than kLargestForceError or are no numbers.
/// @param error  estimated_force_error()
/// @throws ComputationError naming the angle, the error and the usual causes
void require_accurate_forces(double error, double theta);

/// Which of two solutions that differ is wrong, as far as can be told.
enum class Fault { multipliers, inverse_dynamics, undecided };

/// Simbody's multipliers are at fault where their own estimated error is of the size of the
/// difference, our inverse dynamics where that error is within what is allowed and far below the
/// difference.
/// @param difference  force_difference() of the two
/// @param estimated   estimated_force_error() of the multipliers
Fault fault_of(double difference, double estimated);

/// Refuses a state at which multipliers and inverse dynamics differ by more than
/// kLargestForceError.
/// @param difference  force_difference() of the two
/// @param estimated   estimated_force_error() of the multipliers; asked only where they differ
/// @throws ComputationError naming the angle, both figures and whose fault it is
void require_agreement(double difference, const std::function<double()>& estimated, double theta);

/// Number of constraint equations and rank of their matrix G.
struct Rank {
  int equations = 0;
  int rank = 0;
  int mobilities = 0;
};
/// @param state  dynamics state realized to Position
Rank constraint_rank(const PumpSystem& pump, const SimTK::State& state);

/// An error as text: two digits are more than is known of it.
std::string short_text(double error);

/// Runs `job`; what Simbody throws becomes a ComputationError of one line.
void translate_simbody_errors(const std::function<void()>& job);

/// Of the largest constraint force. Measured: sound pumps below 1e-12, random ones of ordinary size
/// and masses included (tests/property_test.cpp holds that none of them is refused).
inline constexpr double kLargestForceError = 1e-8;

}  // namespace bentaxis::multibody

// How far Simbody's constraint multipliers can be trusted at one state.
//
// Simbody solves G M^-1 G^T lambda = right side and drops directions in which that matrix is
// singular to round-off, without a word. It is so where bodies of very different mass meet, or
// where constraints are almost dependent.
#pragma once

#include <functional>

#include "pump_system.h"
#include "reactions.h"

namespace bentaxis::multibody {

/// Estimated error of the constraint forces at any state, over the largest of them.
///
/// What the solver drops shows as accelerations that violate the
/// constraints: G udot is off by e = getUDotErr(). Accelerations that would not be off differ from
/// Simbody's by du with G du = e, and equilibrium with them needs other multipliers:
/// G^T dlambda = M du. No second model and no tolerance of the solver enters.
/// @param state  dynamics state realized to Acceleration
double estimated_force_error(const PumpSystem& pump, const SimTK::State& state);

/// Largest difference between the forces of two solutions of the same state over the largest force;
/// the drive torque counts as a force at the joint circle.
double force_difference(const PumpSystem& pump, const Reactions& reactions,
                        const Reactions& others);

/// Refuses reactions that have lost more than kLargestForceError.
/// @param error  share of the largest force
/// @throws ComputationError naming the angle, the error and the usual causes
void require_accurate_forces(double error, double theta);

/// Runs `job`; what Simbody throws becomes a ComputationError of one line.
void translate_simbody_errors(const std::function<void()>& job);

/// Of the largest constraint force. Measured: sound pumps below 1e-12, random ones of ordinary size
/// and masses included (tests/property_test.cpp holds that none of them is refused).
inline constexpr double kLargestForceError = 1e-8;

}  // namespace bentaxis::multibody

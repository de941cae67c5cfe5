// How far Simbody's constraint solver can be trusted at one state.
#pragma once

#include <functional>

#include "bentaxis/multibody/pump_system.h"

namespace bentaxis::multibody {

/// Estimated error of the constraint forces at a state, over the largest of them.
///
/// Simbody solves G M^-1 G^T lambda = right side and drops directions in which that matrix is
/// singular to round-off, without a word. It is so where bodies of very different mass meet, or
/// where constraints are almost dependent. What it drops shows as accelerations that violate the
/// constraints: G udot is off by e = getUDotErr(). Accelerations that would not be off differ from
/// Simbody's by du with G du = e, and equilibrium with them needs other multipliers:
/// G^T dlambda = M du. No second model and no tolerance of the solver enters.
/// @param state  dynamics state realized to Acceleration
double estimated_force_error(const PumpSystem& pump, const SimTK::State& state);

/// Refuses reactions that have lost more than kLargestForceError.
/// @throws ComputationError naming the angle, the error and the usual causes
void require_accurate_forces(const PumpSystem& pump, const SimTK::State& state, double theta);

/// Runs `job`; what Simbody throws becomes a ComputationError of one line.
void translate_simbody_errors(const std::function<void()>& job);

/// Of the largest constraint force. Measured: sound pumps below 1e-12, random ones of ordinary size
/// and masses included (tests/property_test.cpp holds that none of them is refused).
inline constexpr double kLargestForceError = 1e-8;

}  // namespace bentaxis::multibody

// The multibody model carried through time by what turns its shaft.
#pragma once

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::multibody {

/// Steps after which a simulation gives up: some ten minutes.
inline constexpr long kMaxSteps = 1000000;
inline constexpr long kMostSteps [[deprecated("use kMaxSteps")]] = kMaxSteps;

/// What integrates a simulation, and when it gives up.
struct SimulationMethod {
  Integrator integrator = Integrator::runge_kutta_merson;
  long most_steps = kMaxSteps;
};

/// Simulates the motion of a case from its [drive] by Simbody's own integration: shaft, block and
/// pistons are held by joints and constraints, rigid teeth by one more, compliant teeth push each
/// other by a force element, a motor's rotor is a body. Steps end at every row, edge of a chamber's
/// pressure, touch and end of a touch, and at every point of the drive's curve.
/// @param options  without an accuracy: accuracy_for() the wanted error
/// @throws InputError where the case cannot be simulated: no [drive], a block whose motion is
///         imposed, bore forces off B, no axial inertia, dry friction that jumps where speeds may
///         vanish
/// @throws ComputationError naming time and cause where the integration fails or would not end
Trajectory simulate(const Case& the_case, const Assumptions& assumptions,
                    const PressureTrace& pressure, const SimulationOptions& options = {},
                    const Progress& progress = {}, const SimulationMethod& method = {});

/// Accuracy per step for which reactions are found to be within an error of their peak.
double accuracy_for(double error);

}  // namespace bentaxis::multibody

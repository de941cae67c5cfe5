// Friction of the pistons and losses of the shaft, set so that two mean torques come out.
#pragma once

#include <vector>

#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// Mean drive torques of a case, Nm: by the analytic model with piston friction, by the multibody
/// model without.
struct MeanTorques {
  double with_friction = 0, without_friction = 0;
};

/// One step: both parameters, and the mean torques that they give.
struct FrictionStep {
  double piston_coulomb = 0;  ///< friction.piston_coulomb_N
  double torque_factor = 0;   ///< friction.shaft_torque_factor
  MeanTorques torques;
};

/// Finds friction.piston_coulomb_N and friction.shaft_torque_factor with which the mean torques are
/// `wanted`, to six digits. Ct Td without friction is fixed by the pressure, and what friction adds
/// is in proportion to Fc, so a few steps are enough. Torques that were set so are calibrated, not
/// predicted.
/// @return the steps from the case's own parameters; the last has found them
/// @throws InputError where the case has no Coulomb friction to start from, where the factor would
///         leave (0, 1], or where the friction would be negative; ComputationError where the last
///         step does not give the wanted torques
std::vector<FrictionStep> calibrate_friction(Case the_case, const MeanTorques& wanted,
                                             const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

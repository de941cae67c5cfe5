// The multibody model as equations of motion, for an integration that carries oil too.
#pragma once

#include <memory>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/mechanics.h"

namespace bentaxis::multibody {

/// Equations of motion of a case's [drive] from Simbody, of the bodies and force elements that
/// simulate() carries through time. Angles and speeds of shaft, block and rotor are given;
/// Simbody's constraints place the pistons to round-off. Accelerations follow along the motions
/// that the constraints allow, rows by Simbody's multipliers for all of them.
/// @param the_case  outlives it; its chamber pressure is not asked for
/// @throws InputError as simulate(); also where dry friction jumps (`regularization_m_per_s` = 0)
///         and the motion depends on it
/// @throws ComputationError where the pump cannot be assembled
std::unique_ptr<Mechanics> mechanics(const Case& the_case, const Assumptions& assumptions);

}  // namespace bentaxis::multibody

// The closed form as equations of motion, for an integration that carries oil too.
#pragma once

#include <memory>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/mechanics.h"

namespace bentaxis::analytic {

/// Equations of motion of a case's [drive] from the closed form, as simulate() integrates them.
/// @param the_case  outlives it; its chamber pressure is not asked for
/// @throws InputError as simulate(); also where dry friction jumps (`regularization_m_per_s` = 0)
///         and the motion depends on it
std::unique_ptr<Mechanics> mechanics(const Case& the_case, const Assumptions& assumptions);

}  // namespace bentaxis::analytic

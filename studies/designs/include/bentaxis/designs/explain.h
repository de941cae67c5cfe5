// Why results differ from a reference: the parameters that would explain it.
#pragma once

#include "bentaxis/study/regression.h"

namespace bentaxis::designs {

/// Looks for the one parameter, or else the two, whose change makes the analytic results those of
/// the reference: by exact derivatives, then computed again with the change (Gauss-Newton steps).
/// An outcome that does not differ, and one that was held to no curves, stays as it is. Changes
/// nothing but `outcome.explanation`; an error becomes its reason. Interrupted alone gets out.
/// @param base  the case of the analytic results as it was read: its pressures not computed
void explain(study::Outcome& outcome, const Case& base,
             const study::PartProgress& progress_of = study::silent());
/// Likewise of what `study::hold` made of a reference.
void explain(study::Outcome& outcome, const study::ReferencePlace& place,
             const study::PartProgress& progress_of = study::silent());

}  // namespace bentaxis::designs

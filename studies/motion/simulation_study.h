// The pieces of simulate(). Internal.
#pragma once

#include "bentaxis/study/simulation.h"

namespace bentaxis::study {

// The analytic model is cheap: it is integrated to at most this error, so much better that it is
// the truth beside Simbody.
inline constexpr double kAnalyticError = 1e-8;
inline constexpr double kOneTime = 1e-12;  // of the duration: times nearer than that are one

// Runs the models that a result asks for and compares them.
void run_simulation(SimulationResult& result, const PartProgress& progress_of);
// Balances of work, power and oil of its runs.
// @param one_integrator  for both models
void add_checks(SimulationResult& result, bool one_integrator);

}  // namespace bentaxis::study

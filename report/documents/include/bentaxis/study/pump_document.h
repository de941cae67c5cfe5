// A pump by the analytic model alone: its picture, its forces and its curves, at once.
#pragma once

#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// One driven turn of the analytic model, with all loads on all bodies.
struct ShownPump {
  PreparedCase ready;
  ModelRun run;
  std::vector<analytic::ValidityLimit> limits;
};

/// @throws InputError, ComputationError
ShownPump show_pump(Case the_case, const PartProgress& progress_of = silent());

/// A report that compares nothing, and says so.
/// @throws InputError where `[plausibility] meant` is wrong
report::Document pump_document(const ShownPump& pump, const report::Lines& program);
/// The curves that its figures name.
report::Curves pump_curves(const ShownPump& pump);

}  // namespace bentaxis::study

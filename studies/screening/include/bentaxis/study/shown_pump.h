// A pump by the analytic model alone, with what a report shows of it.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// One driven turn of the analytic model, with all loads on all bodies.
struct ShownPump {
  PreparedCase ready;
  ModelRun run;
  std::vector<analytic::ValidityLimit> limits;
  CaseDescription description;

  /// What is asked first, in sentences: torque and forces, and what makes them invalid.
  std::vector<std::string> answers() const;
};

/// @throws InputError (also where `[plausibility] meant` is wrong), ComputationError
ShownPump show_pump(Case the_case, const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

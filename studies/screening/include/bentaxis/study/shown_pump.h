// A pump by the analytic model alone, with what a report shows of it.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// What is asked first of a pump, in sentences: torque and forces, and what makes them invalid.
/// @param by  put before the sentences on results: "By the analytic model: "
std::vector<std::string> pump_answers(const PreparedCase& ready, const ResultTable& table,
                                      const std::vector<analytic::ValidityLimit>& limits,
                                      const std::string& by = "");

/// One driven turn of the analytic model, with all loads on all bodies.
struct ShownPump {
  PreparedCase ready;
  ModelRun run;
  std::vector<analytic::ValidityLimit> limits;
  CaseDescription description;

  std::vector<std::string> answers() const;
};

/// @throws InputError (also where `[plausibility] meant` is wrong), ComputationError
ShownPump show_pump(Case the_case, const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

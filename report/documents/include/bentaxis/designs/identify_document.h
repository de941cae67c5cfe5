// What an identification found, as a report, as files and as words.
#pragma once

#include <string>

#include "bentaxis/designs/identify.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::designs {

report::Document identify_document(const DataModel& model, const Identification& result,
                                   const report::Lines& program,
                                   const study::CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document identify_document(
    const DataModel& model, const Identification& result, const report::Lines& program) {
  return identify_document(model, result, program, study::describe(model.base()));
}
/// "mean:Td (low)", "Rb1_x1_N over the turn at 30 deg", "prior of pump.tilt_deg".
std::string name_of(const DataModel& model, const WorstResidual& worst);
/// For the terminal.
std::string identify_text(const DataModel& model, const Identification& result);
/// The identified pump as the text of a case file. A comment at its head says how well it fits; of
/// a refuted fit the case's name says so too.
std::string identified_case_text(const DataModel& model, const Identification& result);
/// Unknowns with their limits.
std::string unknowns_csv(const DataModel& model, const Identification& result);
/// Reactions over the turn with their bands; "" without a posterior.
std::string bands_csv(const DataModel& model, const Identification& result);

}  // namespace bentaxis::designs

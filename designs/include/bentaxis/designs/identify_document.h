// What an identification found, as a report, as files and as words.
#pragma once

#include <string>

#include "bentaxis/designs/identify.h"
#include "bentaxis/report/document.h"

namespace bentaxis::designs {

report::Document identify_document(const DataModel& model, const Identification& result,
                                   const report::Lines& program);
/// For the terminal.
std::string identify_text(const DataModel& model, const Identification& result);
/// Unknowns with their limits.
std::string unknowns_csv(const DataModel& model, const Identification& result);
/// Reactions over the turn with their bands; "" without a posterior.
std::string bands_csv(const DataModel& model, const Identification& result);

}  // namespace bentaxis::designs

// The life of the bearings as a report, as CSV files and as text.
#pragma once

#include <string>

#include "bentaxis/designs/duty_cycle.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::designs {

/// @param program  names and versions
report::Document life_document(const LifeStudy& study, const report::Lines& program,
                               const study::CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document life_document(
    const LifeStudy& study, const report::Lines& program) {
  return life_document(study, program, bentaxis::study::describe(study.the_case));
}

/// One row of the duty cycle a line: shares, loads, the life each uses up.
std::string life_csv(const LifeStudy& study);
/// Loads at every angle of every row by both models.
std::string life_loads_csv(const LifeStudy& study);

/// The result in words and short tables, for a terminal.
std::string life_text(const LifeStudy& study);

}  // namespace bentaxis::designs

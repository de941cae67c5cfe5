// Speed against error as a report, as CSV and as text.
#pragma once

#include <string>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/tradeoff_study.h"

namespace bentaxis::study {

report::Document tradeoff_document(const TradeoffStudy& study, const report::Lines& program,
                                   const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document tradeoff_document(
    const TradeoffStudy& study, const report::Lines& program) {
  return tradeoff_document(study, program, bentaxis::study::describe(study.the_case));
}

/// A row per run.
std::string tradeoff_csv(const TradeoffStudy& study);

/// What to use for which error, and every run, for a terminal.
std::string tradeoff_text(const TradeoffStudy& study);

}  // namespace bentaxis::study

// The paper's figures (paper_study.h) as a report, as CSV and as text.
#pragma once

#include <string>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/paper_study.h"

namespace bentaxis::study {

report::Document paper_document(const PaperStudy& study, const report::Lines& program,
                                const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document paper_document(
    const PaperStudy& study, const report::Lines& program) {
  return paper_document(study, program, bentaxis::study::describe(study.cases.front()));
}
/// A row per panel: axis, our range, verdict.
std::string paper_csv(const PaperStudy& study);
/// The table in words, for a terminal.
std::string paper_text(const PaperStudy& study);

}  // namespace bentaxis::study

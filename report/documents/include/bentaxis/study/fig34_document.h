// The study of Fig. 34 as a report.
#pragma once

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/fig34.h"

namespace bentaxis::study {

report::Document fig34_document(const Fig34Study& study, const report::Lines& program,
                                const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document fig34_document(
    const Fig34Study& study, const report::Lines& program) {
  return fig34_document(study, program, bentaxis::study::describe(study.the_case));
}

}  // namespace bentaxis::study

// The study of Fig. 34 as a report.
#pragma once

#include "bentaxis/report/document.h"
#include "bentaxis/study/fig34.h"

namespace bentaxis::study {

report::Document fig34_document(const Fig34Study& study, const report::Lines& program);

}  // namespace bentaxis::study

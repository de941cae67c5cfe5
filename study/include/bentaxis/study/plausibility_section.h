// The head of every report on a case: the pump in one line, what is doubtful, its picture.
#pragma once

#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"

namespace bentaxis::study {

/// Puts the case, what is doubtful about it and its picture into a report.
void describe_case(report::Document& document, const Case& the_case);

}  // namespace bentaxis::study

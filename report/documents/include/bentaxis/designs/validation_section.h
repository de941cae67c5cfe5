// The error of the model against data, in a report.
#pragma once

#include "bentaxis/designs/validation.h"
#include "bentaxis/report/document.h"

namespace bentaxis::designs {

/// Puts bands and comparison errors into the report of a comparison.
void add_validation(report::Document& document, const Validation& validation);

}  // namespace bentaxis::designs

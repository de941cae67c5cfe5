// Advice on the timing of the ports in the report of an operating point.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/timing_advice.h"
#include "bentaxis/report/document.h"

namespace bentaxis::designs {

/// A line for each verdict beyond its limit: what to change, and what that does.
std::vector<std::string> advice_texts(const TimingStudy& study);
/// Adds them to the answers of the report, and the table of changes.
void add_advice(report::Document& document, const TimingStudy& study);

}  // namespace bentaxis::designs

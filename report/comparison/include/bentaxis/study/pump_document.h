// A pump by the analytic model alone: its picture, its forces and its curves, at once.
#pragma once

#include "bentaxis/report/document.h"
#include "bentaxis/study/shown_pump.h"

namespace bentaxis::study {

/// A report that compares nothing, and says so.
report::Document pump_document(const ShownPump& pump, const report::Lines& program);
/// The curves that its figures name.
report::Curves pump_curves(const ShownPump& pump);

}  // namespace bentaxis::study

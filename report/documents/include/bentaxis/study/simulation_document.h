// A simulation as the document of report.json and of its page.
#pragma once

#include <string>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/simulation.h"

namespace bentaxis::study {

/// @param program  what computed it: names and versions
report::Document simulation_document(const SimulationResult& result, const report::Lines& program,
                                     const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document simulation_document(
    const SimulationResult& result, const report::Lines& program) {
  return simulation_document(
      result, program,
      study::describe(result.ready.the_case, study::silent(), study::Described::inputs));
}

/// Curves over time, with the touches of the teeth marked.
report::Curves simulation_curves(const SimulationResult& result);

/// In words, for a terminal.
std::string simulation_text(const SimulationResult& result);

}  // namespace bentaxis::study

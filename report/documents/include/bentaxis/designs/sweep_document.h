// A sweep as the document of report.json and of its page.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::designs {

/// What came out, in one line.
std::string headline(const SweepResult& result);

/// The lowest and the highest value of each output and its design, or the best where a direction is
/// sought, and how many designs are on the Pareto front.
std::vector<std::string> sweep_answers(const SweepResult& result);

/// Maps, slices, designs over parallel axes, outputs against each other with the Pareto front;
/// tables of ranges, best designs, reasons of infeasible ones and what the other model says. Where
/// there are more designs than a picture shows, evenly chosen ones are drawn, and a note says so.
/// @param program  what computed it: names and versions
report::Document sweep_document(const SweepResult& result, const report::Lines& program,
                                const study::CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document sweep_document(
    const SweepResult& result, const report::Lines& program) {
  return sweep_document(result, program, study::describe(result.base));
}

}  // namespace bentaxis::designs

// What is not known exactly, as the document of report.json and of its page.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/uncertainty.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::designs {

/// @param program  what computed it: names and versions
report::Document uncertainty_document(const UncertaintyResult& result, const report::Lines& program,
                                      const study::CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document uncertainty_document(
    const UncertaintyResult& result, const report::Lines& program) {
  return uncertainty_document(result, program, study::describe(result.the_case));
}

/// In words, for a terminal.
std::string uncertainty_text(const UncertaintyResult& result);

/// Parts of it for other reports: what is not known, and the bands with a table of them.
report::Section parameters_section(const UncertaintyResult& result);
/// What was left out, by reason, and what that does to the parameters; a warning too. Nothing where
/// no sample was.
void add_left_out(report::Document& document, const UncertaintyResult& result);
report::Section bands_section(const UncertaintyResult& result);
std::vector<report::Figure> band_figures(const UncertaintyResult& result);

}  // namespace bentaxis::designs

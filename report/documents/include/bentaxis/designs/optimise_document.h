// An optimisation as the document of report.json and of its page.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/optimise.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::designs {

/// What came out, in one line.
std::string headline(const Optimisation& found);

/// The chosen designs against the case as it is, what binds them, and how sure that is.
std::vector<std::string> optimise_answers(const Optimisation& found);

/// The case files of the chosen designs, each with a comment that says what it is chosen for.
std::vector<std::pair<std::string, std::string>> chosen_cases(const Optimisation& found);

/// Chosen designs, what binds, the front, how sure; figures as of a sweep.
/// @param program  what computed it: names and versions
report::Document optimise_document(const Optimisation& found, const report::Lines& program,
                                   const study::CaseDescription& description);

}  // namespace bentaxis::designs

// A regression for continuous integration and for people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/report/junit.h"
#include "bentaxis/study/regression.h"

namespace bentaxis::study {

/// One outcome as JUnit knows it: a test per model and group of channels.
report::TestSuite suite_of(const Outcome& outcome);

/// What was compared, a row per case, model and group of channels, worst first.
report::Table lines_table(const std::vector<Outcome>& outcomes);

/// A reference: its source, how it was made, its tolerance, and what was found.
report::Section source_section(const Outcome& outcome);

/// Parameters that would explain where results differ; nothing where none was looked for.
std::optional<report::Section> explanation_section(const std::vector<Outcome>& outcomes);

/// All outcomes as the document of a page, with the curves that fail and every external one.
/// @param what     what was held: the name of the folder
/// @param program  names and versions
report::Document regression_document(const std::vector<Outcome>& outcomes, const std::string& what,
                                     const report::Lines& program);

}  // namespace bentaxis::study

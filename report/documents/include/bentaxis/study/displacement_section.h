// Derived displacement in the report of `pressure`: answers, tables, figures.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/derived_displacement.h"

namespace bentaxis::study {

/// What the methods find, and where an efficiency exceeds 100 %: one sentence each.
std::vector<std::string> displacement_answers(const DisplacementStudy& study);

/// Adds the answers to the verdict, tables and figures to the document.
void add_displacement(report::Document& document, const DisplacementStudy& study);

/// The methods as a table for a terminal.
std::string displacement_text(const DisplacementStudy& study);

}  // namespace bentaxis::study

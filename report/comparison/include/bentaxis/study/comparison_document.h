// A comparison as the document of report.json and of the page (docs/report_json.md).
#pragma once

#include <string>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/comparison.h"

namespace bentaxis::study {

/// @param program  what computed it: names and versions
report::Document comparison_document(const ComparisonResult& result, const report::Lines& program,
                                     const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document comparison_document(
    const ComparisonResult& result, const report::Lines& program) {
  return comparison_document(result, program, study::describe(result));
}

/// Engines and the analytic model where Simbody refuses the case. @param refusal  its words
report::Document engine_document(const EngineComparison& engines, const std::string& refusal,
                                 const report::Lines& program, const CaseDescription& description,
                                 const std::string& case_name);

/// The curves that its figures name: of both models, their budgets, and the reference they are held
/// to, with which all rows are there.
report::Curves comparison_curves(const ComparisonResult& result, const report::Document& document,
                                 report::Rows which = report::Rows::all);

/// The result in words for a terminal: verdict, worst channels, checks, warnings.
std::string comparison_text(const ComparisonResult& result);
/// Engines likewise: verdict, digits of each, time against error.
std::string engine_text(const EngineComparison& engines);

}  // namespace bentaxis::study

// Sensitivities as a report, as CSV and as text.
#pragma once

#include <optional>
#include <string>

#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::designs {

/// What has no influence is named in a line, not in the tables.
report::Document sensitivity_document(const Sensitivities& found,
                                      const std::optional<SensitivityCheck>& check,
                                      const report::Lines& program,
                                      const study::CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document sensitivity_document(
    const Sensitivities& found, const std::optional<SensitivityCheck>& check,
    const report::Lines& program) {
  return sensitivity_document(found, check, program, study::describe(found.base));
}
/// One row per output and parameter.
std::string sensitivity_csv(const Sensitivities& found,
                            const std::optional<SensitivityCheck>& check);
/// Which parameters an interruption has left out, in a sentence.
std::string left_out_text(const Sensitivities& s);
/// The parameters that matter most to each output.
std::string sensitivity_text(const Sensitivities& found,
                             const std::optional<SensitivityCheck>& check);

}  // namespace bentaxis::designs

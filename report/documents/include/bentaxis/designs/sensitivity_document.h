// Sensitivities as a report, as CSV and as text.
#pragma once

#include <optional>
#include <string>

#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/report/document.h"

namespace bentaxis::designs {

/// What has no influence is named in a line, not in the tables.
report::Document sensitivity_document(const Sensitivities& found,
                                      const std::optional<SensitivityCheck>& check,
                                      const report::Lines& program);
/// One row per output and parameter.
std::string sensitivity_csv(const Sensitivities& found,
                            const std::optional<SensitivityCheck>& check);
/// The parameters that matter most to each output.
std::string sensitivity_text(const Sensitivities& found,
                             const std::optional<SensitivityCheck>& check);

}  // namespace bentaxis::designs

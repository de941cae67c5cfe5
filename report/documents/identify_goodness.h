// Whether an identified pump fits the data: the test, the largest residuals, and the further
// unknown that would help.
#pragma once

#include <string>

#include "bentaxis/designs/identify.h"
#include "bentaxis/report/document.h"

namespace bentaxis::designs {

/// What is left out of the report of a fit that the data refute, and why.
inline constexpr const char* kWithheld =
    "Profile limits, posterior, bands of the reactions and useful further measurements are "
    "withheld: they would hold only if the model were right.";

/// The condition under which a datum is known: "1500 rpm; with Cc".
std::string known_text(const DataModel& model, const Datum& datum);
/// What is known of a datum from outside.
std::string given_text(const Datum& datum);

/// "chi-square 70.1 with 73 degrees of freedom, p = 0.57"
std::string test_text(const GoodnessOfFit& fit);
/// The same with what it means.
std::string fit_text(const GoodnessOfFit& fit);
/// By what and why linear standard deviations are widened.
std::string birge_text(const GoodnessOfFit& fit);
/// A residual with what is given and what the model says.
std::string worst_line(const DataModel& model, const Identification& result,
                       const WorstResidual& worst);
/// The further unknown that would improve the fit most, and those that would do as well.
std::string further_text(const DataModel& model, const Identification& result);

report::Section goodness_section(const Identification& result);
report::Section worst_section(const DataModel& model, const Identification& result);
report::Section further_section(const DataModel& model, const Identification& result);

}  // namespace bentaxis::designs

// What every report says of the case itself.
#pragma once

#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"

namespace bentaxis::study {

/// The case as it was read.
report::CaseSection case_section(const Case& the_case);

/// What both models are given, and what would catch a mistake in it.
/// @param motion       of a simulation of its [drive]; otherwise at constant speed
/// @param oil_follows  in it the oil is simulated too
std::vector<report::CommonInput> common_inputs(const Case& the_case, bool motion,
                                               bool oil_follows = false);

/// Where a run leaves what was modelled.
std::vector<report::ValidityRow> validity_section(
    const std::vector<analytic::ValidityLimit>& limits);

/// Displacement, stroke, ideal flow and torque, ..
std::vector<report::DerivedQuantity> derived_section(const Case& the_case);

}  // namespace bentaxis::study

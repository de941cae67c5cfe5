// Sections that reports on many designs share: of sweeps and of optimisations.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/report/document.h"
#include "sweep_view.h"

namespace bentaxis::designs {

/// What was varied, between which values.
report::Section plan_section(const SweepResult& result, const SweepView& view);
/// Range of each output and its designs.
report::Section outputs_section(const SweepView& view);
/// Reasons of infeasible designs, alike ones counted together.
report::Section infeasible_section(const SweepResult& result, const SweepView& view);
/// The Pareto front, or the best designs where one output alone is sought.
report::Section best_section(const SweepView& view);

/// How many of the designs are valid: "1 of 2 best designs is not valid over the whole turn".
/// @param which  "best", "chosen"
std::string validity_text(const std::vector<DesignValidity>& designs, const std::string& which);
/// "for 1 of 2 best designs", for the verdict of a report; "" where all are valid.
std::string not_valid_designs(const std::vector<DesignValidity>& designs, const std::string& which);
/// Adds which limits do not hold, and how the outputs validity.* are asked for.
/// @param option  "--subject-to" or "--output"
/// @param every   of how many designs of the plan one is here
void append_limits(std::vector<std::string>& answers, const std::vector<DesignValidity>& designs,
                   const std::string& option, std::size_t every = 1);

}  // namespace bentaxis::designs

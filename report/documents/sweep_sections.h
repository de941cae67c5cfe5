// Sections that reports on many designs share: of sweeps and of optimisations.
#pragma once

#include <cstddef>
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
/// Rows of designs: their values and results.
void put_designs(const SweepView& view, const std::vector<std::size_t>& designs,
                 report::Table& table);

}  // namespace bentaxis::designs

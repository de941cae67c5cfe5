// What the drive's torque and power go into, over a turn, by both models.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/hydraulics/power.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// The budgets of a comparison: tables of results/budget.h, and how far they are apart line by
/// line.
struct BudgetComparison {
  ResultTable analytic, multibody;
  compare::Comparison comparison;
  std::vector<compare::Check> checks;  ///< each model's parts against its own Td, Tcs and Fh
  /// The oil's energy balance, with the hydraulic model: of the analytic and of the multibody
  /// model's case.
  std::optional<hydraulics::PumpPower> analytic_oil = {}, multibody_oil = {};
};

/// Compares each line with its own peak; what is round-off of the case's loads counts as nothing.
/// Checks are over the peak of what the parts must add up to.
BudgetComparison compare_budgets(ResultTable analytic, ResultTable multibody, double tolerance,
                                 const compare::ZeroScales& scales);

/// Marks the lines that differ as explained where a split of the budgets by assumption leaves no
/// more than its tolerance.
void explain(BudgetComparison& budgets, const compare::Split& split,
             const compare::ZeroScales& scales);

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/budget_section.h")
#include "bentaxis/study/budget_section.h"
#endif

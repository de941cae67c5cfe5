// What the drive's torque and power go into, over a turn, by both models.
#pragma once

#include <string>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/report/document.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// The budgets of a comparison: tables of results/budget.h, and how far they are apart line by
/// line.
struct BudgetComparison {
  ResultTable analytic, multibody;
  compare::Comparison comparison;
  std::vector<compare::Check> checks;  ///< each model's parts against its own Td, Tcs and Fh
};

/// Compares each line with its own peak; what is round-off of the case's loads counts as nothing.
/// Checks are over the peak of what the parts must add up to.
BudgetComparison compare_budgets(ResultTable analytic, ResultTable multibody, double tolerance,
                                 const compare::ZeroScales& scales);

/// Marks the lines that differ as explained where a split of the budgets by assumption leaves no
/// more than its tolerance.
void explain(BudgetComparison& budgets, const compare::Split& split,
             const compare::ZeroScales& scales);

/// The budgets with power, efficiencies and the block's balance, for a report.
/// @param first       the analytic model's case; its hydraulics give the balance of the oil
/// @throws ComputationError where that balance cannot be integrated
/// @param analytic, multibody  all channels of the same runs
report::Budget budget_section(const BudgetComparison& budgets, const ReadyCase& first,
                              const ReadyCase& second, const ResultTable& analytic,
                              const ResultTable& multibody);

/// Mean torque by cause in a line of words, of the analytic model: "drive torque 294.7 Nm: ..".
std::string budget_text(const BudgetComparison& budgets);

}  // namespace bentaxis::study

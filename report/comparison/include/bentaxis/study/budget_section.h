// The torque budgets of a comparison for a report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/budget.h"

namespace bentaxis::study {

/// The budgets with power, efficiencies and the block's balance, for a report.
/// @param first       the analytic model's case; its hydraulics give the balance of the oil
/// @throws ComputationError where that balance cannot be integrated
/// @param analytic, multibody  all channels of the same runs
report::Budget budget_section(const BudgetComparison& budgets, const PreparedCase& first,
                              const PreparedCase& second, const ResultTable& analytic,
                              const ResultTable& multibody);

/// One run of a budget: a column of the section.
struct BudgetTurn {
  const PreparedCase& ready;
  const ResultTable& budget;                 ///< of results/budget.h
  const ResultTable& table;                  ///< all channels of the same run
  std::optional<hydraulics::PumpPower> oil;  ///< its balance; of the hydraulic model
};

/// The same of runs that are compared with nothing, one or more.
report::Budget budget_section(const std::vector<BudgetTurn>& turns);

/// Mean torque by cause in a line of words, of the analytic model: "drive torque 294.7 Nm: ..".
std::string budget_text(const BudgetComparison& budgets);

}  // namespace bentaxis::study

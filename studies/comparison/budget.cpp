#include "bentaxis/study/budget.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bentaxis::study {

BudgetComparison compare_budgets(ResultTable analytic, ResultTable multibody, double tolerance,
                                 const compare::ZeroScales& scales) {
  BudgetComparison budgets;
  budgets.comparison =
      compare::compare_tables(analytic, multibody, compare::above_round_off(tolerance, scales));
  struct Sum {
    const char *open, *whole, *group;
  };
  const Sum sums[] = {{"Td_open_Nm", "Td_z1_Nm", "parts of Td"},
                      {"Tcs_open_Nm", "Tcs_z2_Nm", "parts of Tcs"},
                      {"Fh_open_N", "Fpress_z2_N", "Fh"}};
  for (const ResultTable* table : {&analytic, &multibody})
    for (const auto& [open, whole, group] : sums) {
      const Channel& channel = table->channels[table->find(open)];
      compare::Check check;
      check.table = table->name;
      check.name = channel.meaning;
      check.group = group;
      check.unit = channel.unit;
      check.scale = compare::scale_of(*table, table->channels[table->find(whole)], scales);
      check.tolerance = tolerance;
      for (std::size_t row = 0; row < table->rows(); ++row) {
        const double value = std::abs(table->at(row, table->find(open)));
        if (value <= check.worst) continue;
        check.worst = value;
        check.theta_deg = table->theta_deg[row];
      }
      budgets.checks.push_back(std::move(check));
    }
  budgets.analytic = std::move(analytic);
  budgets.multibody = std::move(multibody);
  return budgets;
}

void explain(BudgetComparison& budgets, const compare::Split& split,
             const compare::ZeroScales& scales) {
  for (compare::ChannelComparison& line : budgets.comparison.channels)
    for (const compare::ChannelSplit& part : split.channels)
      if (line.verdict == compare::Verdict::differs && part.computed &&
          part.channel.name == line.channel.name &&
          part.rest <=
              split.tolerance * part.peak + compare::kNoSignal * scales.at(line.channel.unit))
        line.verdict = compare::Verdict::explained;
}

}  // namespace bentaxis::study

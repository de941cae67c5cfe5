// Designs as Python sees them: of a sweep and of a search.
#pragma once

#include <map>
#include <string>

#include "bentaxis/designs/sweep.h"
#include "table.h"
#include "words.h"

namespace bentaxis::python {

/// Parameters that vary and outputs of each design, in memory that its owner keeps.
inline Table designs_table(std::string name, const designs::SweepPlan& plan, std::size_t rows,
                           const double* values, const double* results) {
  Table table;
  table.name = std::move(name);
  table.rows = rows;
  table.first_is_index = false;
  const std::size_t n = table.first_of_block = plan.varied.size();
  for (const designs::Varied& varied : plan.varied)
    table.columns.push_back(
        {varied.variable.name(), varied.variable.unit(), varied.variable.meaning(), values++, n});
  for (const designs::Output& output : plan.outputs)
    table.columns.push_back(
        {output.name, output.unit, output.meaning, results++, plan.outputs.size()});
  return table;
}

/// Why designs have no outputs, by row.
inline std::map<std::size_t, std::string> reasons_of(const designs::SweepResult& designs) {
  std::map<std::size_t, std::string> reasons;
  for (const auto& [design, reason] : designs.infeasible)
    reasons.emplace(design, in_python(reason));
  return reasons;
}

}  // namespace bentaxis::python

// What is asked of comparisons, answered in sentences.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/study/comparison.h"
#include "bentaxis/study/regression.h"

namespace bentaxis::study {

/// The most important first: what the reference says and what would explain a difference from it,
/// what differing assumptions do, torque and forces, and what makes them invalid: limits of the
/// models, the oil's timing, digits lost to round-off.
std::vector<std::string> comparison_answers(const ComparisonResult& result);

/// Every reference that does not agree, worst first, with what would explain it; where all agree,
/// what is nearest to its limit.
std::vector<std::string> regression_answers(const std::vector<Outcome>& outcomes);

/// All that there is to print of references: summary, answers, table.
std::string regression_report(const std::vector<Outcome>& outcomes);

}  // namespace bentaxis::study

// How much round-off decides of a result, found by repetition: the same run on copies of the pump
// whose inputs differ by one unit in the last place.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Every copy of a case was refused: how much its result lost to rounding is not known.
class NoEstimate : public ComputationError {
 public:
  using ComputationError::ComputationError;
};

/// Largest difference of each scale group of reactions over its peak; 0 where nobody computed it,
/// NaN where one table lacks a value of it.
std::map<std::string, double> largest_of_groups(const compare::Comparison& comparison);

/// Largest change of each group over its peak in `table` over four copies of the case with every
/// input of the pump moved by one unit in the last place, up or down at random (seeded). A copy
/// that is refused says nothing; where all are, nothing is known.
/// @param table    of the case itself
/// @param options  for the scales of groups that are zero
/// @throws NoEstimate where every copy is refused, naming the last refusal
std::map<std::string, double> rounding_spread(const Case& the_case, const ResultTable& table,
                                              const compare::Options& options,
                                              const std::function<ResultTable(const Case&)>& run);

}  // namespace bentaxis::study

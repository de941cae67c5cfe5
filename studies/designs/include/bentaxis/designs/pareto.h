// Which of many designs no other one beats.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bentaxis::designs {

/// Designs of which no other is as good in every output that matters and better in one. Equal ones
/// are all on the front; where a value that matters was not computed a design takes no part.
/// @param results    designs x outputs, row by row
/// @param direction  of each output: -1 smaller is better, 1 larger, 0 does not matter
/// @return numbers of the designs, rising; none where no output matters
std::vector<std::size_t> pareto_front(std::span<const double> results,
                                      std::span<const int> direction);

}  // namespace bentaxis::designs

// The two ways in which sensitivities are found. Internal.
#pragma once

#include <cstddef>
#include <vector>

#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// The numbers below `count` that are wanted.
template <class Wanted>
std::vector<std::size_t> numbers(std::size_t count, const Wanted& wanted) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < count; ++i)
    if (wanted(i)) list.push_back(i);
  return list;
}

/// Places of outputs and variables in a Sensitivities.
struct Pairs {
  std::vector<std::size_t> outputs, variables;
  bool empty() const { return outputs.empty() || variables.empty(); }
};

/// Exact derivatives by the closed form, of what has them.
/// @return every pair of these was found
Pairs find_exact(Sensitivities& s, const study::PartProgress& progress_of);

/// Derivatives of outputs by differences, with respect to one variable alone: others stay as the
/// case has them, or follow it where they do by default.
void find_by_differences(Sensitivities& s, std::size_t variable,
                         const std::vector<std::size_t>& outputs, const Progress& progress);

/// Why there is no derivative where an evaluation gives no value of an output, or not twice.
inline constexpr const char* kNoDifferences = "no differences could be formed";

}  // namespace bentaxis::designs

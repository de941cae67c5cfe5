// Which values a unit shows, and where they come from. Internal.
#pragma once

#include <cstddef>
#include <vector>

#include "machine.h"
#include "plant.h"

namespace bentaxis::fmu {

struct OutputPlace {
  PlantColumn column;
  enum class From { state, row, check, oil } from = From::row;
  std::size_t index = 0;  ///< there
  double unit_in_si = 1;  ///< what the value there is divided by
  double factor = 1;      ///< and what the quotient is multiplied by
};
/// @param si  in units of the SI, and named so
std::vector<OutputPlace> output_places(const Machine& machine, bool si);

enum class Flag { inertia, contact, flank, film, point, thrust, saturation, vapour };
struct FlagRule {
  Flag flag;
  PlantColumn column;
};
std::vector<FlagRule> flag_rules(const Machine& machine);

}  // namespace bentaxis::fmu

// Progress of a job that is made of pieces.
#pragma once

#include <cstddef>
#include <utility>

#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Progress of piece `number` of a job of `pieces` that take about as long as each other.
inline Progress within(Progress whole, std::size_t number, std::size_t pieces) {
  return [=, whole = std::move(whole)](double fraction) {
    if (whole) whole((static_cast<double>(number) + fraction) / static_cast<double>(pieces));
  };
}

}  // namespace bentaxis::study

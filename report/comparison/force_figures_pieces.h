// What the diagrams of forces have in common.
#pragma once

#include <cstddef>
#include <vector>

#include "bentaxis/study/force_figures.h"

namespace bentaxis::study {

inline constexpr const char* kTimeAxis = "time (ms)";

/// Where a row is on the axis of the run: shaft angle in deg, or time in ms.
double along(const DiagramRun& run, std::size_t row);

/// At most so many rows, evenly spread, the first among them.
std::vector<std::size_t> frame_rows(std::size_t rows, std::size_t most);

/// Which of these rows is nearest to a shaft angle, of whole turns regardless.
std::size_t nearest_frame(const DiagramRun& run, const std::vector<std::size_t>& rows,
                          double theta_deg);

}  // namespace bentaxis::study

// Terminal: progress, interruption, words for numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/results/result_table.h"
#include "bentaxis/study/failed_point.h"

namespace bentaxis::cli {

/// From here on Ctrl-C, SIGTERM and SIGHUP end a run at its next progress report.
void watch_for_interruption();

/// Throws Interrupted when the user has asked to stop.
void stop_if_interrupted();

/// Progress of a named job: a line on standard error if that is a terminal, nothing otherwise.
/// Throws Interrupted when the user has asked to stop.
Progress progress_of(const std::string& job);

/// Says which points of a series could not be computed, on standard error.
/// @return the exit status: that of a failed computation where there are any, else `status`
int status_of_series(int status, const std::vector<study::FailedPoint>& failed, std::size_t points);

}  // namespace bentaxis::cli

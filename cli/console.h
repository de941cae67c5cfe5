// Terminal: progress, interruption, words for numbers.
#pragma once

#include <string>

#include "bentaxis/results/result_table.h"

namespace bentaxis::cli {

/// From here on Ctrl-C, SIGTERM and SIGHUP end a run at its next progress report.
void watch_for_interruption();

/// Throws Interrupted when the user has asked to stop.
void stop_if_interrupted();

/// Progress of a named job: a line on standard error if that is a terminal, nothing otherwise.
/// Throws Interrupted when the user has asked to stop.
Progress progress_of(const std::string& job);

}  // namespace bentaxis::cli

// The files beside the report of a simulation.
#pragma once

#include <vector>

#include "bentaxis/study/simulation.h"
#include "report_files.h"

namespace bentaxis::cli {

/// What each model found, its teeth and its oil.
std::vector<TextFile> simulation_files(const study::SimulationResult& result);

}  // namespace bentaxis::cli

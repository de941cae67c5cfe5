// The files beside a report: the curves that its figures show.
#pragma once

#include <vector>

#include "bentaxis/study/comparison.h"
#include "bentaxis/study/engine_comparison.h"
#include "bentaxis/study/simulation.h"
#include "report_files.h"

namespace bentaxis::cli {

/// Channels of both models that were asked for, pressure of a hydraulic case, budgets, teeth.
std::vector<TextFile> comparison_files(const study::ComparisonResult& result);
/// What each engine found.
std::vector<TextFile> engine_files(const study::EngineComparison& engines);
/// What each model found, its teeth and its oil.
std::vector<TextFile> simulation_files(const study::SimulationResult& result);

}  // namespace bentaxis::cli

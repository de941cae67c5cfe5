// The files beside a report: the curves that its figures show.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bentaxis/study/comparison.h"
#include "bentaxis/study/engine_comparison.h"
#include "report_files.h"

namespace bentaxis::cli {

/// Of a table that is there until the files are written.
template <class Table>
TextFile csv_file(std::string name, const Table& table) {
  return {std::move(name), [&table](const TextSink& write) { write_csv(table, write); }};
}

/// Channels of both models that were asked for, pressure of a hydraulic case, budgets, teeth.
std::vector<TextFile> comparison_files(const study::ComparisonResult& result);
/// What each engine found.
std::vector<TextFile> engine_files(const study::EngineComparison& engines);
}  // namespace bentaxis::cli

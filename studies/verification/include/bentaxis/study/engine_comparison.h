// Engines of others beside both models: which stands alone, with a stored curve as the judge.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/study/progress.h"
#include "bentaxis/study/run.h"

namespace bentaxis::engines {
struct Mechanism;
}

namespace bentaxis::study {

/// Tolerance of an engine at given motion, over the peak of a reaction; of one that is not known
/// that of Simbody (kDrivenTolerance).
double engine_tolerance(const std::string& engine);

struct EngineOptions {
  std::vector<std::string> names;  ///< of engines; empty: none
  /// Folders of stored curves of 50 digits, of which one may be the case's.
  std::vector<std::filesystem::path> curves;
  /// Changes what engines are given: for negative controls.
  std::function<void(engines::Mechanism&)> change = {};
};

/// One engine's results, or why there are none.
struct EngineRun {
  std::string name;
  std::string failure;  ///< "" where there are results
  std::string text;     ///< version and method
  double tolerance = 0;
  double residual = 0;  ///< share of what joints carry beyond their supports
  double seconds = 0;
  ResultTable table;
};

/// How far a result is from another in one group of channels: the channel with the largest
/// difference over its peak.
struct EngineCell {
  compare::Difference difference;
  std::string channel;
  double theta_deg = 0;
  double tolerance = 0;  ///< the larger one of both results
  bool differs() const { return difference.known() && !difference.within(tolerance); }
};

/// A group of channels that share a peak.
struct EngineRow {
  std::string group, unit;
  double peak = 0;                             ///< of the analytic model
  std::vector<std::vector<EngineCell>> pairs;  ///< of two results, by their places
  std::vector<EngineCell> curve;               ///< of a result and the stored curve; or empty
  std::string odd;  ///< results that stand alone: those which the curve says are wrong, else one
                    ///< from which all others differ while two of them agree; "" where none does
};

struct EngineComparison {
  std::vector<EngineRun> runs;
  std::string curve;             ///< name of the stored curve of this case; "" where there is none
  std::size_t curve_angles = 0;  ///< at which it is compared
  std::vector<std::string> results;  ///< "analytic", "multibody", then engines with results
  std::vector<EngineRow> rows;
  /// Channels that no engine gives, with the reason.
  std::vector<std::pair<std::string, std::string>> not_given;

  /// No engine differs from the analytic model or from the curve by more than its tolerance.
  bool agrees() const;
  /// The engines without results, a line each.
  std::vector<std::string> failures() const;
  /// In a sentence: the engines agree, or which one differs most, where, and who stands alone.
  std::string headline() const;
};

/// @throws InputError where a name is no engine
void check_engines(const std::vector<std::string>& names);

/// Runs engines at the samples of a driven run of the analytic model.
/// @throws InputError where the description for engines lacks something of the case
EngineComparison compare_engines(const PreparedCase& ready, const EngineOptions& options,
                                 const ResultTable& analytic, const ResultTable& multibody,
                                 double model_tolerance,
                                 const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

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

/// What an engine does.
enum class EngineWay {
  given,       ///< inverse dynamics at given motion
  integrated,  ///< constant speed: its own integrator and constraints, loads as functions of time
};

/// Tolerance of an engine, over the peak of a reaction; integrated: with its default settings and
/// kEngineSteps.
double engine_tolerance(const std::string& engine, EngineWay way = EngineWay::given);

inline constexpr int kEngineSteps = 1440;  ///< per turn, where nothing else is asked for

struct EngineOptions;
struct EngineComparison;

/// What runs engines. Options bring it along: who compares models can be built without any engine.
struct EngineCalls {
  void (*check)(const EngineOptions& options);  ///< check_engines
  EngineComparison (*compare)(const PreparedCase& ready, const EngineOptions& options,
                              const ResultTable& analytic, const ResultTable* multibody,
                              double model_tolerance,
                              const PartProgress& progress_of);  ///< compare_engines
};
extern const EngineCalls kEngineCalls;  ///< those of the component "verification"

struct EngineOptions {
  std::vector<std::string> names;  ///< of engines; empty: none
  EngineWay way = EngineWay::given;
  int steps = kEngineSteps;           ///< per turn, integrated
  std::vector<std::string> settings;  ///< "ENGINE.NAME=VALUE", integrated
  /// Time against error, integrated: every number of steps of engine_sweep_steps() by every value
  /// of every setting, one setting changed at a time.
  bool sweep = false;
  /// Folders of stored curves of 50 digits, of which one may be the case's.
  std::vector<std::filesystem::path> curves;
  /// Changes what engines are given: for negative controls.
  std::function<void(engines::Mechanism&)> change = {};
  const EngineCalls* calls = &kEngineCalls;
};

/// One engine's results, or why there are none.
struct EngineRun {
  std::string name;
  std::string failure;  ///< "" where there are results
  std::string text;     ///< version and method
  double tolerance = 0;
  double residual = 0;  ///< share of what joints carry beyond their supports
  double seconds = 0;
  double turn_seconds = 0;  ///< integrated: of a turn, without building the model
  ResultTable table;
};

/// One integrated turn of an engine: what it takes and what it gives.
struct EngineEffort {
  std::string engine, setting;   ///< "" or the setting that is not at its default
  std::string failure;           ///< "" where there are results
  int steps = 0;                 ///< per turn
  double seconds = 0;            ///< of a turn, without building the model
  double joints = 0, worst = 0;  ///< largest difference over peak: of Rs; of all channels
  std::string channel;           ///< the one with the largest difference
};
/// Steps per turn of a sweep.
const std::vector<int>& engine_sweep_steps();

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
  EngineWay way = EngineWay::given;
  int steps = 0;   ///< per turn, integrated
  int angles = 0;  ///< at which results are compared
  std::vector<EngineRun> runs;
  std::vector<EngineEffort> sweep;
  int sweep_angles = 0;          ///< at which its errors are taken
  std::string curve;             ///< name of the stored curve of this case; "" where there is none
  std::size_t curve_angles = 0;  ///< at which it is compared
  std::vector<std::string> results;  ///< "analytic", "multibody", then engines with results
  std::size_t models = 0;            ///< of these: both, or the analytic one alone
  std::vector<EngineRow> rows;
  /// Channels that no engine gives, with the reason.
  std::vector<std::pair<std::string, std::string>> not_given;

  bool any_results() const { return results.size() > models; }  ///< of an engine
  /// No engine differs from the analytic model or from the curve by more than its tolerance.
  bool agrees() const;
  /// The engines without results, a line each.
  std::vector<std::string> failures() const;
  /// In a sentence: the engines agree, or which one differs most, where, and who stands alone.
  std::string headline() const;
};

/// @throws InputError where a name is no engine, a setting is not one of its engine's, or the
///         steps have no common angle with the samples
void check_engines(const EngineOptions& options);

/// Runs engines at the samples of a driven run of the analytic model.
/// @param multibody  nothing: that model refuses the case
/// @throws InputError where the description for engines lacks something of the case
EngineComparison compare_engines(const PreparedCase& ready, const EngineOptions& options,
                                 const ResultTable& analytic, const ResultTable* multibody,
                                 double model_tolerance,
                                 const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

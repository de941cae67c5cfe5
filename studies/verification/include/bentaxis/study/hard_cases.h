// The catalogue of hard cases: reading it, and what each model makes of one of its cases.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// One entry of reference_data/hard/catalogue.toml with what its folder holds.
struct HardCase {
  std::string name, group, hard;
  std::vector<std::string> changes;  ///< "pump.tilt_deg = 1e-9": keys that differ from the base
  std::vector<std::string> refused;  ///< models that are expected to refuse
  std::filesystem::path folder;
};

/// The entries whose name contains `filter`.
/// @throws InputError
std::vector<HardCase> read_catalogue(const std::filesystem::path& folder,
                                     const std::string& filter);

/// What is run on a hard case: "analytic", "multibody" (driven, reactions by constraint
/// multipliers) and "residual" (driven, reactions by inverse dynamics).
const std::vector<std::string>& hard_models();

/// Loss of digits in one scale group of reactions, over the group's peak.
struct GroupLoss {
  std::string group;
  double measured = 0;
  double predicted = 0;  ///< of the inputs' part alone where the rest could not be estimated
};

enum class HardVerdict {
  as_predicted,  ///< off by no more than kPredictionFactor times the predicted loss, or by
                 ///< round-off
  refused,       ///< ended with a message, as expected
  wrong,         ///< off by more than predicted, or refused what should be solved
};
/// The words of hardcases.csv. as_predicted is "accurate" there and in the catalogue: as accurate
/// as the inputs' rounding lets it be, which may be a few digits only.
const char* to_string(HardVerdict verdict);

/// What one model made of a hard case.
struct HardOutcome {
  std::string model;
  HardVerdict verdict = HardVerdict::wrong;
  bool refusal_expected = false;
  std::string message;  ///< of the refusal, what is wrong, or what could not be predicted
  std::vector<GroupLoss> groups;
  double seconds_per_angle = 0;
  std::string weak_point;  ///< the input whose rounding matters most

  /// Group with the largest measured loss; nullptr where refused.
  const GroupLoss* worst() const;
  /// Loss measured over loss predicted where the loss exceeds 1e-10 of peak: the farthest from 1.
  std::optional<double> worst_ratio() const;
};

/// Losses above this share of the peak must be predicted within kPredictionFactor.
inline constexpr double kNoticeableLoss = 1e-10;
inline constexpr double kPredictionFactor = 100;
/// A loss up to this share of the peak is round-off, whatever was predicted.
inline constexpr double kRoundOffLoss = 1e-12;

/// Runs all models on a case and holds them against its high-precision curve.
/// @return one outcome for each of hard_models(), in their order
std::vector<HardOutcome> run_hard_case(const HardCase& hard, const PartProgress& progress_of);

/// Largest difference of any reaction within each turn, over the peak of its group; over the scale
/// for its unit where nothing loads the group.
/// @param reference  whose peaks count; `table` has the same channels and angles
std::vector<double> errors_of_turns(const ResultTable& reference, const ResultTable& table,
                                    const compare::ZeroScales& zero_scales, int samples_per_turn);

/// A long integrated run of the rated pump with real, spinning pistons: does anything grow?
struct LongRun {
  struct Turn {
    int number = 0;  ///< from 1
    multibody::WorstErrors record;
    double reaction_error = 0;  ///< largest difference from the analytic model within this turn,
                                ///< over the peak of the reaction
  };
  int turns = 0;
  double accuracy = 0;
  double seconds = 0;
  double work_of_loads = 0;       ///< J: what the work residual is to be compared with
  std::vector<Turn> shown;        ///< 1, 2, 5, 10, .. and the last
  double position_error[2] = {};  ///< m, worst of the first and of the second half
  double reaction_error[2] = {};  ///< likewise
  /// Nothing is worse in the second half by more than a factor of 2.
  bool bounded() const;
};
LongRun run_long(const std::filesystem::path& catalogue, int turns, double accuracy,
                 const PartProgress& progress_of);

}  // namespace bentaxis::study

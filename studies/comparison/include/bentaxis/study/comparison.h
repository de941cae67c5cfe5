// One call from a case, or two, to a verdict: both models run, their tables compared, and what
// there is to know about the difference.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/published.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/results/remarks.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/budget.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/channel_choice.h"
#include "bentaxis/study/lost_digits.h"
#include "bentaxis/study/regression.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/teeth.h"

namespace bentaxis::study {

struct EngineOptions;     // engine_comparison.h
struct EngineComparison;  // likewise

/// What counts as agreement where the user names no tolerance and the model is integrated: the
/// largest difference over the peak. Driven: kDrivenTolerance (achieved_error.h).
inline constexpr double kIntegratedFactor = 100;  ///< achieved error over the accuracy per step
/// Of what no assumption explains, driven: the same equations on both sides.
inline constexpr double kDrivenRestTolerance = 1e-10;

struct ComparisonOptions {
  Way way = Way::driven;
  std::optional<double> tolerance;            ///< of peak, of differences and of rests alike
  ChannelChoice channels;                     ///< what is compared
  multibody::SceneChoice scene;               ///< driven
  multibody::IntegrationOptions integration;  ///< integrated; its accuracy is the last of these:
  std::vector<double> accuracies = {1e-4, 1e-6};
  std::optional<ErrorTarget> target;  ///< integrated: chooses integrator and accuracy instead
  /// Printed numbers to hold the results to (reference_data/published); empty: none.
  std::filesystem::path published;
  std::filesystem::path with;  ///< a reference to hold both models to as well; empty: none
  /// The cases differ in what drives the block: split from the difference as an assumption.
  bool split_transfer = false;
  std::shared_ptr<const EngineOptions> engines;  ///< to run beside driven models; none: none
  bool loads = false;  ///< all loads on the bodies too, of a driven run of full pumps
  /// Folder where values of very many rows are kept meanwhile instead of in the memory (a file
  /// without a name, which is gone with the last table that reads it); empty: none are.
  std::filesystem::path scratch;
};

/// Assumptions in words: name and value.
Lines in_words(const Assumptions& assumptions);

/// An integrated run at one accuracy, and the shaft set free under the analytic torque.
struct IntegrationRow {
  double accuracy = 0;
  double rs = 0, rc = 0, bearings = 0, rcs = 0, td = 0;  ///< largest difference over peak
  multibody::IntegrationRecord record;
  double torque_driven_speed_error = 0;  ///< of omega
};

/// Why models differ that should not: what is known of it.
struct DifferenceCause {
  std::string text;       ///< in a sentence
  double round_off = 0;   ///< of the result that explains it least: estimated, share of its scale
  double over_scale = 0;  ///< and by how much the models differ in it
};

/// A check among those of both models: its key in MultibodyLosses::multipliers.
inline std::string full_name(const compare::Check& check) {
  return check.table + ": " + check.name;
}

/// Whose pump something is of, where each model has its own: "NAME (analytic model)".
std::string pump_name(const Case& the_case, Model model);

/// What is to be known of the second pump, where the multibody model is given another case.
struct OtherPump {
  std::vector<analytic::ValidityLimit> limits;  ///< of the multibody model's results
  Plausibility plausibility;
};

/// Everything that a comparison came to.
struct ComparisonResult {
  PreparedCase first, second;                     ///< of the analytic and of the multibody model
  ComparisonOptions options;                      ///< as used: with the integration that was chosen
  double tolerance = 0;                           ///< of differences over peak
  ResultTable analytic, multibody;                ///< all channels
  BodyLoadTable analytic_loads, multibody_loads;  ///< where asked for, a row per row
  compare::Comparison comparison;                 ///< of the channels asked for
  std::vector<compare::Check> checks;
  std::optional<BudgetComparison> budget;    ///< of a driven run of full pumps whose Td is wanted
  std::optional<TeethComparison> teeth;      ///< likewise, where the contact is that of teeth
  std::vector<AssumptionRow> changes;        ///< where the models assume different things
  std::optional<compare::Split> split;       ///< then: the difference taken apart
  std::vector<IntegrationRow> integrations;  ///< integrated: one per accuracy, the last is compared
  std::string choice;                        ///< integrated to an error: what was chosen
  std::vector<ResultTable>
      without_viscous;  ///< Rcs and Tcs of both models with Cc = 0 (Fig. 32), where it is not
  std::vector<analytic::ValidityLimit> limits;  ///< of the first case
  std::optional<OtherPump> other;               ///< of the second, where it is another one
  std::vector<RoundingLine> rounding;
  MultibodyLosses losses;  ///< of a driven run
  std::vector<Warning> warnings;
  std::optional<compare::PublishedTable> published;
  std::optional<Outcome> with;                      ///< both models held to a reference
  std::shared_ptr<const EngineComparison> engines;  ///< where any were asked for

  const PreparedCase& of(Model model) const { return model == Model::analytic ? first : second; }
  std::string pump_of(Model model) const { return pump_name(of(model).the_case, model); }

  bool checks_hold() const;
  /// The verdict: every check holds, no channel lacks a value it should have, and each difference,
  /// of the torque budgets too, is within tolerance, or where the models assume different things,
  /// what no assumption explains.
  /// What a reference or an engine says is a verdict of its own (`with`, `engines`).
  bool agrees() const;
  /// That, and both models agree with the reference where there is one, and with the engines that
  /// have given results: what the exit status says.
  bool passes() const;
  /// Whether the models agree with each other and not with a reference, whatever engines say: the
  /// headline of a report then says how far they are from it.
  bool agrees_but_for_reference() const;
  /// Why the models differ, where the round-off that was estimated for this case is at least a
  /// tenth of each difference: an estimate of the first order at some angles is no closer.
  std::optional<DifferenceCause> cause() const;
  /// The verdict in a sentence, with the tolerance that counted: where it is that they differ, the
  /// result or the check that failed.
  std::string headline() const;
};

/// Whether one of the tables alone has values of a channel: with a smaller scene. They agree with
/// nothing.
bool only_one_computed(const compare::Comparison& comparison);

/// Runs both models on a case, or on one each, and compares.
/// @param multibody_case  of the multibody model where it is another one: what would a wrong input
///                        do? Must have the same pistons, samples and revolutions.
/// @throws InputError, also where the options leave nothing to compare; ComputationError
ComparisonResult compare_models(Case analytic_case, std::optional<Case> multibody_case,
                                const ComparisonOptions& options,
                                const PartProgress& progress_of = silent());

/// @throws InputError where two cases cannot be compared angle by angle
void check_same_run(const Case& first, const Case& second);

/// What a report of it says of the case: its own runs have the turn where they have all loads.
CaseDescription describe(const ComparisonResult& result,
                         const PartProgress& progress_of = silent());

}  // namespace bentaxis::study

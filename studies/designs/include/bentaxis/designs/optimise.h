// The best designs of a pump: any parameters, several objectives, constraints, one or several
// operating points.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/duty_cycle.h"
#include "bentaxis/designs/search.h"
#include "bentaxis/designs/sweep.h"
#include "bentaxis/designs/sweep_parts.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// Whether the search is compared with random and grid search at as many evaluations.
enum class SearchComparisonChoice {
  fast,  ///< where designs are evaluated by the kernel of the closed form
  yes,
  no,
};

inline constexpr int kMaxSamples = 100000;  ///< of [uncertainty], for a quantile

/// What a command line says of an optimisation. Outputs by name; with "@N" behind it, "peak:Rb1@2",
/// at the operating point of row N of the conditions alone; with "q95:" before it, "q95:peak:Rb1",
/// the value that 95 % of the pumps of a design stay below under [uncertainty].
struct OptimiseRequest {
  std::vector<std::pair<std::string, std::string>> vary;  ///< name; FROM:TO or a list
  std::vector<std::string> minimise, maximise, outputs;
  std::vector<std::string> subject_to;  ///< "OUTPUT <= NUMBER" or "OUTPUT >= NUMBER"
  study::Model model = study::Model::analytic;
  std::filesystem::path conditions;  ///< a duty cycle, or empty
  SearchOptions search;
  std::size_t samples = 100;  ///< of [uncertainty], for each quantile of each design
  SearchComparisonChoice comparison = SearchComparisonChoice::fast;
};

/// The same from a study file (docs/optimisation.md); a file it names is beside it.
/// @throws InputError
OptimiseRequest read_optimise_request(const std::filesystem::path& file);

/// A limit that a design must keep, at every operating point.
struct Constraint {
  std::size_t output = 0;  ///< of the plan's outputs
  bool at_most = true;     ///< <= limit, else >=
  double limit = 0;        ///< in the output's unit
};

/// What is sought.
struct OptimisePlan {
  /// What varies and the outputs: ranges as uniform distributions, lists as levels. An output that
  /// has a direction is an objective.
  SweepPlan designs;
  /// What is computed at every operating point, and of each output of the designs where it is taken
  /// from: which of these, at which row; without a row all of them count.
  std::vector<Output> computed;
  /// Of each of these the share of a quantile under [uncertainty]; nothing: of the case as it is.
  std::vector<std::optional<double>> quantiles = {};
  std::size_t samples = 100;  ///< of [uncertainty]
  struct Taken {
    std::size_t from = 0;
    std::optional<std::size_t> row = std::nullopt;
  };
  std::vector<Taken> taken;
  std::vector<Constraint> constraints;
  DutyCycle conditions;
  SearchOptions search;
  SearchComparisonChoice comparison = SearchComparisonChoice::fast;

  /// Whether a quantile under [uncertainty] is among the outputs.
  bool robust() const;
  /// "timing.backflow.excess <= 0"
  std::string text(const Constraint& constraint) const;
  /// Of designs that the searches evaluate, without refinements.
  std::size_t evaluations() const;
};
/// @throws InputError naming option, value and what is allowed
OptimisePlan optimise_plan(const OptimiseRequest& request, const Case& base);

/// A design by its number among those evaluated, and what it is chosen for: "balanced",
/// "lowest mean:Td_Nm".
struct ChosenDesign {
  std::string why;
  std::size_t design = 0;
};

/// Another way to spend as many evaluations.
struct SearchComparison {
  std::string name;  ///< "random", "grid"
  std::size_t evaluations = 0, feasible = 0;
  std::vector<double> best;  ///< of each objective, in its unit; not_computed() without a feasible
                             ///< design
  /// Volume that its front dominates over that of the search, below the worst point of the search's
  /// front; above 1 where it is better. Of up to three objectives, else not_computed().
  double share_of_front = 0;
  double seconds = 0;  ///< of its evaluations
};

/// What came out. Outputs are means over the operating points, weighted by their shares of the
/// time; of an output that is constrained and not sought the value at the point where it is worst.
struct Optimisation {
  OptimisePlan plan;
  /// All designs evaluated, in that order. One that violates a constraint is infeasible, its reason
  /// says which, and its results are not_computed(); `measured` has them.
  SweepResult designs;
  std::vector<double> measured;      ///< designs x outputs, row by row
  std::vector<double> violations;    ///< of each design; infinite where it has no values
  Evaluation own;                    ///< outputs of the case as it is, and why it is infeasible
  std::vector<ChosenDesign> chosen;  ///< of the front; empty where no design is feasible
  SearchResult search;
  double evaluation_seconds = 0;  ///< of designs.seconds, without what the search itself takes
  std::size_t kept = 0;           ///< batches that an earlier run had computed
  std::size_t kept_singles = 0;   ///< designs outside of batches likewise: of gradients
  std::vector<SearchComparison> comparisons;  ///< empty where not asked for

  std::size_t evaluated() const { return designs.designs; }
  std::size_t feasible() const { return designs.designs - designs.infeasible.size(); }
  /// Front of each search on its own over that of all designs, as volumes that they dominate below
  /// the worst point of the front of all: 1 where a search finds everything alone. Of up to three
  /// objectives: of more a volume would take longer than the search.
  std::vector<double> shares_of_front;
  std::vector<DesignValidity> validity = {};  ///< of each chosen design: validity_of_chosen()
};

/// The case of a design. @throws InputError
Case case_of(const Optimisation& found, std::size_t design);

/// Where batches of designs are computed and kept.
struct OptimiseWork {
  int threads = 0;  ///< 0: one per processor
  /// Kept there as they are computed and, where `resume` is set, taken from there.
  const SweepParts* parts = nullptr;
  bool resume = false;
  /// Of several processes that make the same search: each computes every `ranks`-th piece of a
  /// batch, and `sum` adds up the numbers of all.
  std::size_t rank = 0, ranks = 1;
  std::function<void(std::span<double>)> sum = {};
};

/// A search for the best designs of a case. Immutable.
class Optimiser {
 public:
  /// @throws InputError where the case itself or the plan is refused
  Optimiser(Case base, OptimisePlan plan);
  ~Optimiser();
  Optimiser(Optimiser&&) noexcept;

  const OptimisePlan& plan() const;
  /// What batches depend on. @param program  name and version
  SweepRecord record(const std::string& program) const;
  /// Number of batches that are kept.
  std::size_t batches() const;

  /// The same designs for the same plan, whatever the number of threads and processes.
  /// @throws InputError, ComputationError where there is no design with values
  Optimisation run(const OptimiseWork& work, const Progress& progress) const;

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

/// Every design that was evaluated, a line each, and those of the front.
std::string evaluations_csv(const Optimisation& found);
std::string front_csv(const Optimisation& found);

}  // namespace bentaxis::designs

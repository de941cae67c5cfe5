// Sweeps: outputs of many designs, in blocks that can be computed anywhere and resumed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/difference.h"
#include "bentaxis/designs/design_validity.h"
#include "bentaxis/designs/distribution.h"
#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/points.h"

namespace bentaxis::designs {

enum class Sampling {
  grid,             ///< every combination of levels, the last variable fastest
  latin_hypercube,  ///< of distributions
  sobol,
  random,
};
/// Words for them, in the order of the enumeration: grid, lhs, sobol, random.
const std::vector<std::string>& sampling_words();
std::string to_string(Sampling sampling);

/// One variable of a sweep.
struct Varied {
  Variable variable;
  std::vector<double> levels;      ///< of a grid; else, where not empty, each is as likely
  Distribution distribution = {};  ///< of the others; a whole number is the nearest one
};

/// What is to be computed; all that results depend on but the case.
struct SweepPlan {
  Sampling sampling = Sampling::grid;
  std::vector<Varied> varied;
  std::size_t samples = 0;  ///< of all but a grid
  std::uint64_t seed = 1;   ///< likewise
  std::vector<Output> outputs;
  std::vector<int> direction;  ///< of each output: -1 smaller is better, +1 larger, 0 neither
  study::Model model = study::Model::analytic;
  double check_share = 0;  ///< of the designs, recomputed by the other model

  /// Number of designs. @throws InputError where it cannot be counted
  std::size_t size() const;
};

/// What a command line says of a plan, or a study file (docs/sweeps.md).
struct SweepRequest {
  Sampling sampling = Sampling::grid;
  std::vector<std::pair<std::string, std::string>> vary;  ///< name, values as text
  std::size_t samples = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> outputs, minimise, maximise;
  study::Model model = study::Model::analytic;
  double check_share = 0;
};
/// @throws InputError
SweepRequest read_sweep_request(const std::filesystem::path& file);
/// @throws InputError naming variable or output, value and what is allowed
SweepPlan sweep_plan(const SweepRequest& request, const Case& base);
/// The plan as a study file: it reads back as the same plan.
std::string plan_text(const SweepPlan& plan);

/// Levels of a variable: "20:40:5", "50:400:#8", "log(1:100:#5)", "lumped,real", "1,2,5".
/// @throws InputError
std::vector<double> levels_of(const std::string& text, const Variable& variable);

/// A design that the other model computed too.
struct SweepCheck {
  std::size_t design = 0;
  std::vector<double> own;     ///< one per output: of the plan's model
  std::vector<double> values;  ///< one per output; not_computed() where it gives none
  std::string own_reason;      ///< why the plan's model has none
  std::string reason;          ///< why the other model has none
  /// Of each output: what differences are over; 0: not compared, as both models share it
  /// (`why_not_independent`) or neither has a value.
  std::vector<double> scales;

  /// What the models differ by in an output; Comparable::nothing where it is not compared.
  compare::Difference difference(std::size_t output) const;
  /// The same over its scale: 0 where it is not compared, NaN where one model has no value.
  double error(std::size_t output) const;
  /// Whether the models were compared: not where both refuse the design, or have no output that
  /// each of them computes independently.
  bool compared() const;
  /// They were compared, and all outputs are within the tolerance. A value that one model alone
  /// lacks is no agreement.
  bool agrees(double tolerance) const;
};
/// Of an output's scale: the peak of the reaction over the turn. Both models have been seen to
/// agree to 1e-12 of it; 1e-9 is what `compare` asks for.
inline constexpr double kCheckTolerance = 1e-9;

/// Consecutive designs: what is computed as one and kept in a file of its own.
struct SweepBlock {
  std::size_t first = 0, designs = 0;
  std::vector<double> values;   ///< designs x variables, row by row, files' units
  std::vector<double> results;  ///< designs x outputs
  std::vector<std::string> reasons;
  std::vector<SweepCheck> checks;
};

/// A plan for a case. Immutable: blocks can be computed by many threads, processes and machines; a
/// block depends on case and plan alone.
class Sweep {
 public:
  /// @throws InputError
  Sweep(Case base, SweepPlan plan);
  ~Sweep();
  Sweep(Sweep&&) noexcept;

  const Family& family() const;
  const SweepPlan& plan() const;
  std::size_t designs() const;
  std::size_t blocks() const;
  /// Designs of all blocks but the last: a power of two, the fewer the slower designs are.
  std::size_t block_size() const;

  /// Computes a block.
  /// @param tick  called now and then; may throw to end the work
  SweepBlock compute(std::size_t block, const std::function<void()>& tick) const;

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

/// Results in the order of the designs; of very many only some.
struct SweepResult {
  SweepPlan plan;
  Case base;
  std::size_t designs = 0;      ///< here
  std::size_t every = 1;        ///< they are designs 0, every, 2 every, .. of the plan
  std::vector<double> values;   ///< designs x variables, row by row, files' units
  std::vector<double> results;  ///< designs x outputs, row by row
  /// Reasons of infeasible designs: by number of the design here, rising.
  std::vector<std::pair<std::size_t, std::string>> infeasible;
  std::size_t all_infeasible = 0;  ///< of all designs of the plan
  std::vector<SweepCheck> checks;  ///< of all designs of the plan, by their numbers there
  double tolerance = kCheckTolerance;
  double seconds = 0;
  std::vector<DesignValidity> best = {};  ///< of the best designs: validity_of_best()

  std::size_t compared() const;  ///< number of checks that compared the models
  std::size_t agreeing() const;  ///< of these
  /// Whether all that were compared agree, and any were, where designs were to be checked.
  bool agrees() const;
};

/// Computes all blocks side by side and keeps all results in memory: for sweeps that fit there.
/// @param threads  0: one per processor
SweepResult compute_in_memory(const Sweep& sweep, int threads, const Progress& progress = {});

}  // namespace bentaxis::designs

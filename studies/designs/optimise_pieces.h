// A search for the best designs in pieces: what varies, what a design costs, batches of designs,
// the run.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/optimise.h"
#include "bentaxis/designs/robust.h"

namespace bentaxis::designs {

/// A variable of the search: its values, or where they are listed their places.
struct SearchVariable {
  double low, high;
  bool whole;
};
/// @throws InputError where a search cannot take the range or the list
SearchVariable search_variable(const Varied& varied);

/// What designs of a plan are to the search: outputs at every operating point, costs, constraints.
/// "raw" is what is computed of a design, row by row of the operating points.
struct DesignProblem {
  Case base;
  OptimisePlan plan;
  std::vector<SearchVariable> variables;
  std::vector<std::size_t> objectives;         // outputs with a direction
  Evaluator evaluator;                         // of designs and conditions
  std::optional<QuantileEvaluator> quantiles;  // of these, where quantiles are asked for
  Evaluation own;
  std::vector<double> scales;  // of constraints

  /// @throws InputError where the case itself or the plan is refused
  DesignProblem(Case the_case, OptimisePlan the_plan);

  std::size_t outputs() const { return plan.designs.outputs.size(); }
  std::size_t computed() const { return plan.computed.size(); }  // of each row
  std::size_t rows() const { return plan.conditions.rows.size(); }

  /// Values of the parameters at a point of the search.
  std::vector<double> values_at(std::span<const double> x) const;
  /// The reverse, of the nearest point of the search.
  std::vector<double> point_of(const std::vector<double>& values) const;
  /// Quantiles in the places of what they are of. @return why there are none
  std::string put_quantiles(std::span<const double> values, std::span<double> raw) const;
  /// Outputs of one design at every operating point, row by row. @return why it has none
  std::string compute(std::span<const double> values, std::span<double> raw) const;
  /// The same of several designs.
  void compute(std::span<const double> values, std::span<double> raw,
               std::span<std::string> reasons) const;
  double value_at(std::size_t output, std::size_t row, std::span<const double> raw) const;
  /// How far a design is beyond a constraint at its worst operating point, in the output's unit.
  double beyond(const Constraint& c, std::span<const double> raw) const;
  double mean(std::size_t output, std::span<const double> raw) const;
  /// As Optimisation has them.
  std::vector<double> outputs_in(std::span<const double> raw) const;
  /// The constraints that a design violates; "" where none.
  std::string violated(std::span<const double> raw) const;
  /// Costs and constraints of a design as the search wants them.
  void numbers_of(std::span<const double> raw, std::span<double> numbers) const;
  /// Exact derivatives where every one of them is.
  bool differentiate(std::span<const double> x, std::span<double> jacobian) const;
};

/// Batches of designs: computed by threads and processes, kept in a folder, taken from there.
class DesignBatches {
 public:
  using Compute = std::function<void(std::span<const double> values, std::span<double> raw,
                                     std::span<std::string> reasons)>;
  DesignBatches(const OptimiseWork& work, std::size_t piece, Compute compute)
      : work_(work), piece_(piece), compute_(std::move(compute)) {}

  /// A batch of the size of all.
  SweepBlock make(std::vector<double> values, std::size_t designs, std::size_t numbers,
                  const std::function<void()>& tick);
  /// Designs outside of batches, each of which is kept by itself where `keeps`.
  SweepBlock make_singles(std::vector<double> values, std::size_t designs, std::size_t numbers,
                          bool keeps, const std::function<void()>& tick);
  std::size_t kept() const { return kept_; }
  std::size_t kept_singles() const { return kept_singles_; }

 private:
  /// What an earlier run has kept under this number, where it is of these values.
  std::optional<SweepBlock> found_in(std::size_t number, const std::vector<double>& values) const;
  void keep(std::size_t number, const SweepBlock& block) const;
  /// All processes take a batch from the folder, or none does.
  bool all_have(bool one) const;
  void fill(SweepBlock& block, std::size_t numbers, const std::function<void()>& tick);

  const OptimiseWork& work_;
  std::size_t piece_;
  Compute compute_;
  std::size_t next_ = 0, kept_ = 0, next_single_ = 0, kept_singles_ = 0;
};

/// The search itself. @throws ComputationError where no design has values
Optimisation run_search(const DesignProblem& designs, const OptimiseWork& work,
                        const Progress& progress);

}  // namespace bentaxis::designs

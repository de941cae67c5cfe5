// From values of variables to outputs: the one call under sweeps, sensitivities, uncertainty and
// identification.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/designs/output.h"
#include "bentaxis/designs/variable.h"
#include "bentaxis/study/run.h"

namespace bentaxis::designs {

/// Outputs of one design.
struct Evaluation {
  std::vector<double> values;  ///< one per output; not_computed() where there is none
  std::string reason;          ///< why the design is infeasible, one line; "" where it is not
  bool feasible() const { return reason.empty(); }
};

/// Outputs as functions of variables. Immutable: one object serves many threads. A value does not
/// depend on what else is evaluated with it, nor on threads, but to round-off on the instruction
/// set.
class Evaluator {
 public:
  /// @throws InputError
  Evaluator(Family family, std::vector<Output> outputs,
            study::Model model = study::Model::analytic);
  ~Evaluator();
  Evaluator(Evaluator&&) noexcept;

  const Family& family() const;
  const std::vector<Output>& outputs() const;
  study::Model model() const;
  /// Whether designs are evaluated by the kernel of the closed form, tens of thousands a second.
  bool fast() const;

  /// Outputs of the design with these values of the variables, in the file's units. What a case is
  /// refused for, and a computation that fails, is its reason, never an exception.
  Evaluation evaluate(std::span<const double> values) const;

  /// The outputs alone.
  /// @throws InputError where the case is refused
  /// @throws ComputationError where the computation fails
  std::vector<double> outputs_at(std::span<const double> values) const;

  /// The same of `count` designs, by the calling thread: faster than one by one.
  /// @param values   count x variables, row by row
  /// @param results  count x outputs, row by row
  /// @param reasons  one per design
  void evaluate(std::size_t count, std::span<const double> values, std::span<double> results,
                std::span<std::string> reasons) const;

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace bentaxis::designs

// Quantiles of outputs under the [uncertainty] of a case: what most pumps of one design do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/designs/evaluator.h"

namespace bentaxis::designs {

/// An output of which a quantile is asked for.
struct QuantileOutput {
  Output output;
  double share = 0.5;  ///< of the pumps of a design that lie below it, in (0, 1)
};

/// Quantiles of outputs as functions of variables. Each design is evaluated at the same random
/// numbers, so that designs differ by what they are and not by the draw. The numbers are those of
/// `uncertainty` with the same seed and number of samples. Immutable.
class QuantileEvaluator {
 public:
  /// @param variables  what designs differ in. A distribution of one of them must be given about
  ///                   its value: "normal(0.1)", "relative(0.01)"
  /// @throws InputError where the case has no [uncertainty], a distribution does not move with its
  ///                    variable, or the samples are too few for a quantile
  QuantileEvaluator(const Case& base, const std::vector<Variable>& variables,
                    std::vector<QuantileOutput> outputs, std::size_t samples, std::uint64_t seed,
                    study::Model model);
  ~QuantileEvaluator();
  QuantileEvaluator(QuantileEvaluator&&) noexcept;

  std::size_t samples() const;

  /// @param values   one per variable, in the file's unit
  /// @param results  one per output; not_computed() where a sample has no value
  /// @return why there are none: of the first sample that is refused or fails; "" where there are
  std::string evaluate(std::span<const double> values, std::span<double> results) const;

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace bentaxis::designs

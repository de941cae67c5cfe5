// Whether the limits of validity hold for single designs of many.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"

namespace bentaxis::designs {

struct SweepResult;
struct Optimisation;

/// What the limits of validity say of a design, over the turn by the analytic model.
struct DesignValidity {
  std::size_t design = 0;           ///< its row among the results
  double share = 0;                 ///< of the turn, in which any limit does not hold
  std::string where;                ///< operating point of it; "" without operating points
  std::vector<std::string> limits;  ///< what does not hold, each in a sentence
  std::vector<std::string> keys;    ///< of these: "film" of the output validity.film
  std::string reason;               ///< why nothing can be said, or ""

  bool valid() const { return limits.empty() && reason.empty(); }
  /// "not valid over 7.5 % of the turn", or "" where all limits hold.
  std::string text() const;
};

/// Of a case. What it is refused for, and a computation that fails, is the reason.
DesignValidity validity_of(const Case& the_case);

/// Of the best design by each output that is sought, each design once.
std::vector<DesignValidity> validity_of_best(const SweepResult& result);

/// Of the chosen designs, in their order, at all operating points: the worst of them.
std::vector<DesignValidity> validity_of_chosen(const Optimisation& found);

}  // namespace bentaxis::designs

// Limits within which the model's assumptions hold, checked over a turn or along a motion.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::analytic {

/// One limit of validity over a run: `violated_share` is of its angles, or of the rows of a motion.
struct ValidityLimit {
  std::string limit;          ///< what must hold
  std::string name;           ///< short name of the violation
  std::string key;            ///< one word for it: "flank", "film", ..
  bool applicable = true;     ///< false where the run has nothing to check it by
  double violated_share = 0;  ///< of the angles, 0..1
  double worst = 0;           ///< worst value, in `unit`; meaningful where something was violated
                              ///< or as the nearest approach
  std::string unit;
  double theta_deg = 0;     ///< of the worst value
  std::string consequence;  ///< what a violation means, with figures
  /// Of every row whether it holds; of none where it is not applicable.
  enum class Row : unsigned char { unknown, holds, violated };
  std::vector<Row> rows = {};
  std::size_t row = 0;  ///< of the worst value
  double margin = 0;    ///< smallest distance from the limit; < 0: violated, or would be
};

/// Share of the angles at which any of the limits is violated, 0..1: it is no pump's behaviour
/// there.
double share_beyond(const std::vector<ValidityLimit>& limits);

/// Checks a table of results (of either model) against the limits of what was modelled: tooth force
/// on the modelled flank, and how far two flanks differ from the one that the paper prints, film
/// force that only pushes, its point within the port plate, thrust of the tapered bearing, friction
/// that only takes energy, bore forces that do no work, no more pairs of teeth in touch than are
/// looked at.
std::vector<ValidityLimit> check_validity(const Case& the_case, const Assumptions& assumptions,
                                          const Samples& samples, const ResultTable& table);

/// The same limits in the rows of a motion, by either model. Shaft and block each have their own
/// angle and speed there, and either direction.
std::vector<ValidityLimit> limits_in_time(const Case& the_case, const Assumptions& assumptions,
                                          const Trajectory& run);

}  // namespace bentaxis::analytic

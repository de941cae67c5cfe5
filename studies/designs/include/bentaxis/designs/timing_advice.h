// What to change where the timing of the ports is beyond a limit: found by trials, one key at a
// time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/designs/variable.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/results/remarks.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// A key changed alone, and what that does to a verdict.
struct TimingChange {
  Variable variable;
  double from = 0, to = 0;                   ///< in the file's unit
  double value_before = 0, value_after = 0;  ///< of the verdict, in its unit
  bool within = false;                       ///< its limit holds afterwards
  double efficiency_change = 0;              ///< volumetric efficiency after minus before, %
  std::vector<std::string> worse;  ///< verdicts within their limits before and beyond after

  /// "port_plate.suction_arc_deg.1 27 -> 23: .."
  std::string text(const TimingRow& row) const;
};

/// Advice on one verdict that is beyond its limit without a stated reason.
struct TimingAdvice {
  TimingRow row;
  /// The smallest trial that brings it within its limit and nothing else beyond; where there is
  /// none, the one that brings the fewest others beyond; then the one that helps most. Nothing
  /// where no key makes it better by a tenth of what it is beyond.
  std::optional<TimingChange> change;
};

struct TimingStudy {
  std::vector<TimingAdvice> advice;  ///< none where every verdict is within its limit
  std::size_t trials = 0, failed = 0;
};

/// Tries ends of the arcs (1 to 8 deg either way), notches and their areas, the width of the
/// kidneys and the suction pressure, one at a time: some 70 periodic states, side by side.
/// @param state  of the case
/// @throws InputError, ComputationError where every trial fails
TimingStudy timing_advice(const Case& the_case, const hydraulics::SteadyState& state,
                          const Progress& progress = {});

}  // namespace bentaxis::designs

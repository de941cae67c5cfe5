// Effects of the port timing, each with its angle, its limit and whether it exceeds it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/hydraulics/accuracy_log.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/remarks.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// The verdicts that docs/hydraulics.md, "Timing", defines, in its order. `meant` is the reason
/// that `[plausibility] meant` of the case gives for one that exceeds its limit.
/// @throws InputError where `[plausibility] meant` is wrong
std::vector<TimingRow> timing_rows(const Case& the_case, const hydraulics::SteadyState& state);

/// What the rows are about, in their order.
struct TimingQuantity {
  std::string code, quantity, unit;
  bool searched = false;  ///< found by a search over the speed, not from one state
};
const std::vector<TimingQuantity>& timing_quantities();

/// Those that exceed their limits without a reason.
std::vector<Warning> timing_warnings(const std::vector<TimingRow>& rows);

/// Says that computed chamber pressures are less accurate than `curve_error` of their cases allows;
/// none where all are.
std::optional<Warning> accuracy_warning(const hydraulics::AccuracyLog::Record& record);
/// The same of one state.
std::optional<Warning> accuracy_warning(const Case& the_case, const hydraulics::SteadyState& state);

/// Names of all verdicts, which `[plausibility] meant` may give reasons for.
std::vector<std::string> timing_codes();

/// A line for each verdict, for a terminal.
std::string timing_text(const std::vector<TimingRow>& rows);

/// The largest speed that keeps a limit on suction.
struct SuctionSpeed {
  bool filling = false;  ///< the limit is on the filling of the chambers, not on their pressure
  /// Pa gauge, which no chamber may be below; of filling: share of a stroke that may be lost.
  double limit = 0;
  std::optional<double> rpm;                  ///< where the least chamber pressure crosses it
  double searched_from = 0, searched_to = 0;  ///< rpm
  double least = 0;     ///< Pa gauge, least chamber pressure at the end looked at last
  int solves = 0;       ///< periodic states
  std::string stopped;  ///< why the search ended before its bounds, or ""
  /// Speeds looked at, rpm, and the share of a stroke that incomplete filling costs there.
  std::vector<std::pair<double, double>> losses;
};

/// The speed at which the least chamber pressure crosses `limit`: from the speed of the case
/// upwards by factors of 1.25, 8 times at most, where it keeps above it there, else downwards to a
/// twentieth of it; then by TOMS 748 to a thousandth. Everything but the speed stays as it is.
/// @param limit  Pa gauge
/// @throws InputError, ComputationError where the case's own speed has no periodic state
SuctionSpeed suction_speed(const Case& the_case, double limit, const Progress& progress = {});

/// The same for the speed at which incomplete filling costs 1 % of a stroke.
/// @throws ComputationError also where no chamber is ever open to the suction port alone
SuctionSpeed filling_speed(const Case& the_case, const Progress& progress = {});

/// As one more verdict: exceeded where it is below the speed of the case.
TimingRow suction_speed_row(const Case& the_case, const SuctionSpeed& found);

}  // namespace bentaxis::study

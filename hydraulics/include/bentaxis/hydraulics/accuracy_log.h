// Which computed pressures have a larger estimated error than their cases allow.
#pragma once

#include <cstddef>
#include <filesystem>

#include "bentaxis/pump/case.h"

namespace bentaxis::hydraulics {

struct SteadyState;

/// An operating point whose chamber pressure is less accurate than `curve_error` of its case.
struct InaccurateState {
  std::filesystem::path file;  ///< of the case
  double speed_rpm = 0;
  double delivery = 0;  ///< Pa gauge, as the case gives it
  double error = 0;     ///< estimated, of the chamber pressure, over its peak
  double limit = 0;     ///< `curve_error`
};

InaccurateState inaccurate_state(const Case& the_case, const SteadyState& state);

/// While one of these exists, steady_state() notes every state that is less accurate than its case
/// allows, from any thread. Without one it does not. One at a time.
class AccuracyLog {
 public:
  AccuracyLog();
  ~AccuracyLog();
  AccuracyLog(const AccuracyLog&) = delete;
  AccuracyLog& operator=(const AccuracyLog&) = delete;

  /// How many states have been noted, and the one that exceeds its limit by the largest factor.
  struct Record {
    std::size_t count = 0;
    InaccurateState worst;
  };
  static Record record();
  static void note(const Case& the_case, const SteadyState& state);
};

}  // namespace bentaxis::hydraulics

// Elapsed time, for the figures that runs and studies report.
#pragma once

#include <chrono>

namespace bentaxis {

/// Runs from its construction. Wall-clock time by a clock that is never set back.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace bentaxis

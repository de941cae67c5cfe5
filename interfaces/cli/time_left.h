// How long a job will take yet, for the line that shows its progress.
#pragma once

#include <cmath>
#include <string>

namespace bentaxis::cli {

/// ", 40 s left", after `passed` seconds with `fraction` of the job done: as if the rest went as
/// fast. Nothing where too little is done to say.
inline std::string time_left(double passed, double fraction) {
  if (passed < 2 || fraction < 0.01) return "";
  const auto seconds = static_cast<long>(std::ceil(passed / fraction - passed));
  if (seconds < 60) return ", " + std::to_string(seconds) + " s left";
  const long minutes = (seconds + 59) / 60;
  if (minutes < 60) return ", " + std::to_string(minutes) + " min left";
  return ", " + std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min left";
}

}  // namespace bentaxis::cli

// Points of a series that could not be computed: the series keeps the others and names these.
#pragma once

#include <string>
#include <vector>

namespace bentaxis::study {

struct FailedPoint {
  double value = 0;    ///< of what the series varies, in its unit; the number of a row of a file
  std::string point;   ///< "delivery_bar = 175"
  std::string reason;  ///< of the computation
};

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/failed_points.h")
#include "bentaxis/study/failed_points.h"
#endif

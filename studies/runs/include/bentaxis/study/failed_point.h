// Points of a series that could not be computed: the series keeps the others and names these.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/error.h"

namespace bentaxis::study {

struct FailedPoint {
  double value = 0;    ///< of what the series varies, in its unit; the number of a row of a file
  std::string point;   ///< "delivery_bar = 175"
  std::string reason;  ///< of the computation
};

/// Does a job. @return why it is refused or fails, one line; "" where it is done
template <class Job>
std::string reason_of(const Job& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  } catch (const ComputationError& error) {
    return error.what();
  }
  return "";
}

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/failed_points.h")
#include "bentaxis/study/failed_points.h"
#endif

// Points of a series that could not be computed: the series keeps the others and names these.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/pump/error.h"

namespace bentaxis::study {

struct FailedPoint {
  double value = 0;    ///< of what the series varies, in its unit; the number of a row of a file
  std::string point;   ///< "delivery_bar = 175"
  std::string reason;  ///< of the computation
};

/// Takes from a series what could not be computed and names it.
/// @param reasons  one per point; "" where it was computed
/// @param point    of one that failed, by its number: its value and its name
/// @param keep     moves point `from` to place `to`
/// @param series   for the message where nothing is left: "no point of the series"
/// @throws ComputationError where no point was computed
template <class Point, class Keep>
std::vector<FailedPoint> without_failed(const std::vector<std::string>& reasons, const Point& point,
                                        const Keep& keep, const std::string& series) {
  std::vector<FailedPoint> failed;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    if (reasons[i].empty()) {
      keep(i, kept++);
      continue;
    }
    failed.push_back(point(i));
    failed.back().reason = reasons[i];
  }
  if (kept == 0 && !reasons.empty())
    throw ComputationError(series + (series.empty() ? "" : " could be computed; the first: ") +
                           reasons[0]);
  return failed;
}

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

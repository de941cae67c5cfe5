// Points of a series that could not be computed, in a report.
#pragma once

#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/failed_point.h"

namespace bentaxis::study {

/// A warning for each: "point-failed".
inline void add_warnings(report::Document& document, const std::vector<FailedPoint>& failed) {
  if (failed.empty()) return;
  auto& all = document.warnings ? *document.warnings : document.warnings.emplace();
  for (const FailedPoint& f : failed)
    all.push_back({"point-failed", f.point + " could not be computed: " + f.reason});
}

}  // namespace bentaxis::study

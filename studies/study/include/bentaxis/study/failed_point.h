// Points of a series that could not be computed: the series keeps the others and names these.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::study {

struct FailedPoint {
  double value = 0;    ///< of what the series varies, in its unit; the number of a row of a file
  std::string point;   ///< "delivery_bar = 175"
  std::string reason;  ///< of the computation
};

/// A warning for each: "point-failed".
inline void add_warnings(report::Document& document, const std::vector<FailedPoint>& failed) {
  if (failed.empty()) return;
  auto& all = document.warnings ? *document.warnings : document.warnings.emplace();
  for (const FailedPoint& f : failed)
    all.push_back({"point-failed", f.point + " could not be computed: " + f.reason});
}

}  // namespace bentaxis::study

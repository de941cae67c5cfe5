#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/study/engine_comparison.h"

namespace bentaxis::study {

bool EngineComparison::agrees() const {
  return std::none_of(rows.begin(), rows.end(), [&](const EngineRow& row) {
    for (std::size_t i = models; i < results.size(); ++i)
      if (row.pairs[0][i].differs() || (!row.curve.empty() && row.curve[i].differs())) return true;
    return false;
  });
}

std::vector<std::string> EngineComparison::failures() const {
  std::vector<std::string> lines;
  for (const EngineRun& run : runs)
    if (!run.failure.empty()) lines.push_back(run.failure);
  return lines;
}

std::string EngineComparison::headline() const {
  const EngineCell* worst = nullptr;
  const EngineRow* where = nullptr;
  std::string engine;
  for (const EngineRow& row : rows)
    for (std::size_t i = models; i < results.size(); ++i)
      if (const EngineCell& cell = row.pairs[0][i];
          cell.difference.known() &&
          (worst == nullptr || cell.difference.share() / cell.tolerance >
                                   worst->difference.share() / worst->tolerance)) {
        worst = &cell;
        where = &row;
        engine = results[i];
      }
  if (worst == nullptr) return "No engine has given results.";
  const std::string largest = fmt::format(
      "{} of {} at {:g} deg: {} of peak from the analytic model (tolerance {:g})", worst->channel,
      engine, worst->theta_deg, worst->difference.share_text(), worst->tolerance);
  if (agrees()) return "All engines agree. Largest difference: " + largest + ".";
  return fmt::format("Engines differ: {}.{}", largest,
                     where->odd.empty()
                         ? ""
                         : fmt::format(" {} {}.",
                                       where->curve.empty() ? "Alone against the others:"
                                                            : "Wrong by the stored curve:",
                                       where->odd));
}

}  // namespace bentaxis::study

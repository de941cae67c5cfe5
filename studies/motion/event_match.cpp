#include "event_match.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/results/max_abs.h"

namespace bentaxis::study {

EventMatch match_events(const std::vector<ToothEvent>& analytic,
                        const std::vector<ToothEvent>& multibody, double until_s) {
  const std::vector<ToothEvent>* lists[] = {&analytic, &multibody};
  std::vector<const ToothEvent*> touches[2];
  EventMatch match;
  for (int model = 0; model < 2; ++model) {
    for (const ToothEvent& event : *lists[model])
      if (event.touch && event.time_s <= until_s) {
        touches[model].push_back(&event);
        match.mean_impulse[model] += event.impulse;
        match.largest_impulse[model] = std::max(match.largest_impulse[model], event.impulse);
      }
    match.touches[model] = touches[model].size();
    if (match.touches[model] > 0)
      match.mean_impulse[model] /= static_cast<double>(match.touches[model]);
  }
  // In order of time; a touch belongs to the one of the same flank that is next in time.
  for (std::size_t i = 0, j = 0; i < touches[0].size() && j < touches[1].size();) {
    const ToothEvent& a = *touches[0][i];
    const ToothEvent& m = *touches[1][j];
    const double apart = m.time_s - a.time_s;
    const auto nearer = [&](const std::vector<const ToothEvent*>& list, std::size_t at,
                            const ToothEvent& to) {
      return at + 1 < list.size() && list[at + 1]->flank == to.flank &&
             std::abs(list[at + 1]->time_s - to.time_s) < std::abs(apart);
    };
    if (a.flank != m.flank || nearer(touches[0], i, m) || nearer(touches[1], j, a)) {
      ++(a.time_s < m.time_s ? i : j);
      continue;
    }
    ++match.matched;
    update_max_abs(match.time_s, apart);
    if (match.largest_impulse[0] > 0)
      update_max_abs(match.impulse, (m.impulse - a.impulse) / match.largest_impulse[0]);
    ++i;
    ++j;
  }
  return match;
}

}  // namespace bentaxis::study

// Touches of two runs that belong together. Internal.
#pragma once

#include <vector>

#include "bentaxis/study/simulation.h"

namespace bentaxis::study {

/// Touches of both models until a time.
EventMatch match_events(const std::vector<ToothEvent>& analytic,
                        const std::vector<ToothEvent>& multibody, double until_s);

}  // namespace bentaxis::study

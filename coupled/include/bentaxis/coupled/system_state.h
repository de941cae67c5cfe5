// What motion and oil are at a time.
#pragma once

#include <vector>

#include "bentaxis/results/mechanics.h"

namespace bentaxis::coupled {

/// States of both.
struct SystemState {
  MotionVector motion{};
  std::vector<double> oil;
};

}  // namespace bentaxis::coupled

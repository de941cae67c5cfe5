// Former name of max_abs.h.
#pragma once

#include "bentaxis/results/max_abs.h"

namespace bentaxis {

[[deprecated("use update_max_abs")]] inline void keep_worst(double& worst, double error) {
  update_max_abs(worst, error);
}

}  // namespace bentaxis

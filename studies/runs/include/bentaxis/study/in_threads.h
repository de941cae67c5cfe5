// Deprecated: include bentaxis/numerics/parallel_for.h or bentaxis/study/reporting.h.
#pragma once

#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/study/reporting.h"

namespace bentaxis::study {

[[deprecated("use bentaxis::numerics::parallel_for")]] inline void in_threads(
    int threads, std::size_t count, const std::function<void(std::size_t)>& job) {
  numerics::parallel_for(threads, count, job);
}

}  // namespace bentaxis::study

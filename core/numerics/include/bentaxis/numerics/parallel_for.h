// Jobs side by side.
#pragma once

#include <cstddef>
#include <functional>

namespace bentaxis::numerics {

/// Calls job(0) .. job(count - 1), one by one as threads are free: a job may take many times as
/// long as another. What jobs leave behind is seen by the caller.
/// @param threads  at most as many, and no more than this process may use processors; 0: all of
/// them
void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& job);

}  // namespace bentaxis::numerics

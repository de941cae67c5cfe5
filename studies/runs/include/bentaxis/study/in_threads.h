// Jobs side by side, and how far they are.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// Calls job(0) .. job(count - 1), one by one as threads are free: a job may take many times as
/// long as another. What jobs leave behind is seen by the caller.
/// @param threads  at most as many, and no more than this process may use processors; 0: all of
/// them
void in_threads(int threads, std::size_t count, const std::function<void(std::size_t)>& job);

/// Whoever listens is called by one thread at a time, and may throw to end the work.
class Reporting {
 public:
  Reporting(std::size_t all, Progress progress) : all_(all), progress_(std::move(progress)) {}

  /// One of all is done.
  void done() {
    const std::lock_guard lock(mutex_);
    ++done_;
    tell();
  }
  /// A sign of life.
  /// @param first  called before it, by one thread at a time too
  void tick(const std::function<void()>& first = {}) {
    const std::lock_guard lock(mutex_);
    if (first) first();
    tell();
  }

 private:
  void tell() {
    if (progress_) progress_(static_cast<double>(done_) / static_cast<double>(all_));
  }
  std::mutex mutex_;
  std::size_t all_, done_ = 0;
  Progress progress_;
};

}  // namespace bentaxis::study

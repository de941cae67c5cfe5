// How far jobs that run side by side are.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

#include "bentaxis/study/progress.h"

namespace bentaxis::study {

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

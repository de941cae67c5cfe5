// How far jobs that run side by side are.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

#include "bentaxis/numerics/parallel_for.h"
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

/// Calls job(0) .. job(count - 1) side by side and reports each that is done.
/// @param threads  0: one per processor
inline void for_each_of(std::size_t count, int threads, const Progress& progress,
                        const std::function<void(std::size_t)>& job) {
  Reporting reporting(count, progress);
  numerics::parallel_for(threads, count, [&](std::size_t i) {
    job(i);
    reporting.done();
  });
}

}  // namespace bentaxis::study

// How far jobs that run side by side are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

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

/// One progress of jobs that run side by side: that of the one which is furthest behind.
class SlowestOf {
 public:
  SlowestOf(std::size_t jobs, Progress progress) : done_(jobs), progress_(std::move(progress)) {}

  /// Progress of a part of a job: from .. to of the whole job.
  Progress of(std::size_t job, double from = 0, double to = 1) {
    return [=, this](double fraction) {
      const std::lock_guard lock(mutex_);
      done_[job] = from + fraction * (to - from);
      if (progress_) progress_(*std::min_element(done_.begin(), done_.end()));
    };
  }

 private:
  std::mutex mutex_;
  std::vector<double> done_;
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

#include "bentaxis/study/in_threads.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace bentaxis::study {
namespace {

// Orders what threads hand to each other once more than oneTBB does, whose library a thread
// sanitizer does not see.
std::atomic<long> handed_over{0};

}  // namespace

void in_threads(int threads, std::size_t count, const std::function<void(std::size_t)>& job) {
  if (count == 0) return;
  // Those that this process may use: mpirun and batch systems hand them out.
  const int processors = std::max(1, oneapi::tbb::info::default_concurrency());
  handed_over.fetch_add(1);
  oneapi::tbb::task_arena(threads > 0 ? std::min(threads, processors) : processors).execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const auto& range) {
          handed_over.fetch_add(1);
          for (std::size_t i = range.begin(); i < range.end(); ++i) job(i);
          handed_over.fetch_add(1);
        },
        oneapi::tbb::simple_partitioner());
  });
  handed_over.fetch_add(1);
}

}  // namespace bentaxis::study

#include "bentaxis/study/in_threads.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace bentaxis::study {
namespace {

// Orders what threads hand to each other once more than oneTBB does, whose library a thread
// sanitizer does not see.
std::atomic<long> handed_over{0};

// Arenas of a width that nobody works in. oneTBB 2021.8 keeps 7 kB of every one that there ever
// was.
class IdleArenas {
 public:
  using Arena = std::unique_ptr<oneapi::tbb::task_arena>;

  Arena take(int width) {
    const std::lock_guard lock(mutex_);
    auto& idle = idle_[width];
    if (idle.empty()) return std::make_unique<oneapi::tbb::task_arena>(width);
    Arena arena = std::move(idle.back());
    idle.pop_back();
    return arena;
  }
  void give_back(int width, Arena arena) {
    const std::lock_guard lock(mutex_);
    idle_[width].push_back(std::move(arena));
  }

 private:
  std::mutex mutex_;
  std::map<int, std::vector<Arena>> idle_;
};

IdleArenas& idle_arenas() {
  static IdleArenas arenas;
  return arenas;
}

}  // namespace

void in_threads(int threads, std::size_t count, const std::function<void(std::size_t)>& job) {
  if (count == 0) return;
  // Those that this process may use: mpirun and batch systems hand them out.
  const int processors = std::max(1, oneapi::tbb::info::default_concurrency());
  handed_over.fetch_add(1);
  const int width = threads > 0 ? std::min(threads, processors) : processors;
  IdleArenas::Arena arena = idle_arenas().take(width);
  arena->execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const auto& range) {
          handed_over.fetch_add(1);
          for (std::size_t i = range.begin(); i < range.end(); ++i) job(i);
          handed_over.fetch_add(1);
        },
        oneapi::tbb::simple_partitioner());
  });
  idle_arenas().give_back(width, std::move(arena));  // one that an exception left is not used again
  handed_over.fetch_add(1);
}

}  // namespace bentaxis::study

#include "bentaxis/numerics/parallel_for.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

#include "bentaxis/numerics/object_pool.h"

namespace bentaxis::numerics {
namespace {

using Arenas = ObjectPool<oneapi::tbb::task_arena>;

// Orders what threads hand to each other once more than oneTBB does, whose library a thread
// sanitizer does not see: where the scope begins and where it is left, by an exception too.
class HandOver {
 public:
  HandOver() { count.fetch_add(1); }
  ~HandOver() { count.fetch_add(1); }
  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;

 private:
  static inline std::atomic<long> count{0};
};

// Arenas of a width that nobody works in. oneTBB 2021.8 keeps 7 kB of every one that there ever
// was.
Arenas& arenas_of(int width) {
  static std::mutex mutex;
  static std::map<int, Arenas> arenas;
  const std::lock_guard lock(mutex);
  return arenas[width];
}

}  // namespace

void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& job) {
  if (count == 0) return;
  // Those that this process may use: mpirun and batch systems hand them out.
  const int processors = std::max(1, oneapi::tbb::info::default_concurrency());
  const HandOver to_workers_and_back;
  const int width = threads > 0 ? std::min(threads, processors) : processors;
  Arenas& arenas = arenas_of(width);
  auto arena = arenas.take([&] { return oneapi::tbb::task_arena(width); });
  arena->execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const auto& range) {
          const HandOver from_caller_and_back;
          for (std::size_t i = range.begin(); i < range.end(); ++i) job(i);
        },
        oneapi::tbb::simple_partitioner());
  });
  arenas.give_back(std::move(arena));  // one that an exception left is not used again
}

}  // namespace bentaxis::numerics

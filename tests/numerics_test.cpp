// Methods without physics: jobs side by side, and objects that are used again.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bentaxis/numerics/object_pool.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/study/in_threads.h"

namespace bentaxis::numerics {
namespace {

TEST(ParallelFor, CallsEveryJobOnce) {
  for (const int threads : {0, 1, 2, 1000}) {
    for (const std::size_t count : {0U, 1U, 257U}) {
      std::vector<int> calls(count, 0);
      parallel_for(threads, count, [&](std::size_t i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(count, 1)) << threads;
    }
  }
}

TEST(ParallelFor, OneThreadIsOneThread) {
  std::atomic<int> running{0}, most{0};
  parallel_for(1, 50, [&](std::size_t) {
    most = std::max<int>(most, ++running);
    std::this_thread::yield();
    --running;
  });
  EXPECT_EQ(most, 1);
}

TEST(ParallelFor, JobsMayHaveJobs) {
  std::atomic<int> calls{0};
  parallel_for(2, 5, [&](std::size_t) { parallel_for(2, 7, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls, 35);
}

TEST(ParallelFor, AnExceptionReachesTheCallerAndTheNextCallWorks) {
  for (int i = 0; i < 3; ++i)
    EXPECT_THROW(parallel_for(2, 20,
                              [](std::size_t job) {
                                if (job == 7) throw std::runtime_error("job 7");
                              }),
                 std::runtime_error);
  std::atomic<int> calls{0};
  parallel_for(2, 20, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 20);
}

// The name of version 1.0.0.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
TEST(ParallelFor, HasItsOldName) {
  std::atomic<int> calls{0};
  study::in_threads(2, 20, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 20);
}
#pragma GCC diagnostic pop

TEST(ObjectPool, GivesBackWhatIsUnusedAndMakesWhatLacks) {
  ObjectPool<int> pool;
  int made = 0;
  const auto make = [&] { return ++made; };
  auto first = pool.take(make), second = pool.take(make);
  EXPECT_EQ(*first, 1);
  EXPECT_EQ(*second, 2);
  const int* const address = first.get();
  pool.give_back(std::move(first));
  const auto again = pool.take(make);
  EXPECT_EQ(again.get(), address);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(*pool.take(make), 3);
}

}  // namespace
}  // namespace bentaxis::numerics

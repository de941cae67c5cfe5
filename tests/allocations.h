// Counts what a test allocates; the test program also needs allocations.cpp.
#pragma once

#include <atomic>

namespace bentaxis::test {

inline std::atomic<long> allocations{0};
inline std::atomic<bool> allocations_fail{false};  ///< operator new throws

/// Allocations made since it was built, by any thread.
class AllocationCounter {
 public:
  long count() const { return allocations - before_; }

 private:
  long before_ = allocations;
};

}  // namespace bentaxis::test

// Objects that one thread at a time works with, kept for the next one.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace bentaxis::numerics {

template <class T>
class ObjectPool {
 public:
  /// An unused object, or a new one, which make() returns.
  template <class Make>
  std::unique_ptr<T> take(const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (!unused_.empty()) {
        auto one = std::move(unused_.back());
        unused_.pop_back();
        return one;
      }
    }
    return std::make_unique<T>(make());
  }
  void give_back(std::unique_ptr<T> one) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(std::move(one));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> unused_;
};

}  // namespace bentaxis::numerics

// Reception of messages that may come soon, for both ends of a channel. Internal.
#pragma once

#include <sched.h>
#include <sys/socket.h>
#include <sys/types.h>

#include <cerrno>
#include <chrono>
#include <cstddef>

namespace bentaxis::fmu::process {

/// Looks for a message for some microseconds before it sleeps: to be woken takes longer than a
/// short function of an FMU. It sleeps at once where there is one processor only, and, but for a
/// try now and then, where looking was in vain.
class Receiver {
 public:
  /// As recv().
  ssize_t receive(int socket, void* data, std::size_t size) {
    if (several_processors_ && (in_vain_ < kMaxInVain || ++skipped_ % kTryEvery == 0)) {
      const auto end = std::chrono::steady_clock::now() + kLook;
      do {
        const ssize_t received = recv(socket, data, size, MSG_DONTWAIT);
        if (received >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) {
          in_vain_ = 0;
          return received;
        }
      } while (std::chrono::steady_clock::now() < end);
      if (in_vain_ < kMaxInVain) ++in_vain_;
    }
    return recv(socket, data, size, 0);
  }

 private:
  static constexpr auto kLook = std::chrono::microseconds(50);
  static constexpr int kMaxInVain = 8, kTryEvery = 64;

  static bool several_processors() {
    cpu_set_t allowed;
    return sched_getaffinity(0, sizeof allowed, &allowed) == 0 && CPU_COUNT(&allowed) > 1;
  }

  bool several_processors_ = several_processors();
  int in_vain_ = 0;
  unsigned skipped_ = 0;
};

}  // namespace bentaxis::fmu::process

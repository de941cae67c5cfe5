#include "console.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>

#include "bentaxis/pump/error.h"
#include "commands.h"
#include "time_left.h"

namespace bentaxis::cli {
namespace {

volatile std::sig_atomic_t signalled = 0;

void on_signal(int signal) {
  signalled = 1;
  std::signal(signal, SIG_DFL);  // a second one ends the program at once
}

}  // namespace

void watch_for_interruption() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGHUP, on_signal);
}

void stop_if_interrupted() {
  if (signalled != 0) throw Interrupted();
}

Progress progress_of(const std::string& job) {
  using Clock = std::chrono::steady_clock;
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const auto begun = Clock::now();
  auto shown = std::make_shared<Clock::time_point>(begun);
  return [=](double fraction) {
    if (signalled != 0) {
      if (terminal) std::fputs("\r\033[K", stderr);
      throw Interrupted();
    }
    if (!terminal) return;
    const auto now = Clock::now();
    if (fraction >= 1) {
      std::fputs("\r\033[K", stderr);
    } else if (now - *shown > std::chrono::milliseconds(100)) {
      *shown = now;
      const double passed = std::chrono::duration<double>(now - begun).count();
      std::fprintf(stderr, "\r\033[K%s %3.0f %%%s", job.c_str(), 100 * fraction,
                   time_left(passed, fraction).c_str());
      std::fflush(stderr);
    }
  };
}

int status_of_series(int status, const std::vector<study::FailedPoint>& failed,
                     std::size_t points) {
  if (failed.empty()) return status;
  std::fprintf(
      stderr,
      "bentaxis: %zu of %zu points could not be computed; their rows are empty, the others "
      "are written:\n",
      failed.size(), points);
  for (const study::FailedPoint& f : failed)
    std::fprintf(stderr, "bentaxis: %s: %s\n", f.point.c_str(), f.reason.c_str());
  return kComputationFailed;
}

}  // namespace bentaxis::cli

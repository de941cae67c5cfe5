// Calls to an instance of an FMU, which runs in a process of its own. Internal.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bentaxis/fmu/slave.h"
#include "process/messages.h"
#include "process/receiver.h"
#include "supervisor.h"

namespace bentaxis::fmu {

/// A call, and how messages name it.
struct Call {
  process::Task task;
  std::vector<std::string> names;  ///< "fmi2DoStep at 0.1 s"; of items: one each
  int version = 0;                 ///< of FMI
  double first = 0, second = 0;
  std::vector<process::Item> items = {};
  std::vector<std::string> texts = {};
};

/// What has come back.
struct Returned {
  process::Outcome outcome = process::Outcome::returned;
  int status = 0;  ///< of FMI
  unsigned flags = 0;
  std::size_t index = 0;  ///< of the item at which the call ended
  std::vector<double> values;
  std::string text;
  std::vector<std::string> log;  ///< "error: no level of oil"
};

/// Lines of a reply's log. @param text  as a Reply has them
std::vector<std::string> log_lines(std::string_view text);
/// The last lines, nearest to the reason, in one.
std::string said_last(const std::vector<std::string>& lines);

class Channel {
 public:
  /// Starts a process.
  /// @param fmu  its file, for messages
  Channel(Supervisor& supervisor, std::string fmu, const Limits& limits);
  /// Ends the process.
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// @throws ComputationError naming the call where the FMU does not come back from it: its process
  ///         ends, or the time is over. What limits.while_waiting throws. Then there is no process
  ///         any more.
  Returned call(const Call& call);
  /// Lets the process end by itself.
  /// @throws ComputationError where it does not, or ends in another way
  void leave();
  /// Whether the process is there and waits for calls.
  bool idle() const { return channel_ >= 0; }
  /// From here on: a short time for calls, and nothing interrupts them.
  void hurry();

 private:
  using Clock = std::chrono::steady_clock;
  Returned exchange(const Call& call);
  void send(const Call& call);
  std::optional<Returned> receive_until(Clock::time_point end, bool interruptible);
  [[noreturn]] void give_up_in_time(const Call& call);
  [[noreturn]] void fail(const std::string& what, const std::string& why);
  void close();

  std::string fmu_;
  Limits limits_;
  int channel_ = -1;
  std::vector<char> packet_;
  process::Receiver receiver_;
};

}  // namespace bentaxis::fmu

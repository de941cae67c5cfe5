// What an instance has to say to whoever imports it. Internal.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bentaxis::fmu {

/// As FMI has it, in its order.
enum class Status { ok, warning, discard, error, fatal };

/// A text as people may be shown it: on one line, cut where it is longer than `longest` bytes
/// (between characters of UTF-8), with its size then.
std::string shown(std::string text, std::size_t longest);

class Log {
 public:
  using Sink = std::function<void(Status, const char* category, const std::string& message)>;
  /// @param sink   none: nothing is said
  /// @param debug  whether events are told too
  Log(Sink sink, bool debug) : sink_(std::move(sink)), debug_(debug) {}

  /// Of debug messages those of these categories; of none: all. What is no debug message, warnings
  /// and errors, is always told.
  /// @return false where there is no such category: nothing has then changed
  bool set_debug(bool on, const std::vector<std::string>& categories);

  /// Warnings and what is worse. @return the status
  Status say(Status status, const std::string& message) const noexcept;
  /// Of debug messages.
  void event(const std::string& message) const noexcept;
  bool tells_events() const { return sink_ && debug_ && events_; }

 private:
  Sink sink_;
  bool debug_ = false, events_ = true;
};

}  // namespace bentaxis::fmu

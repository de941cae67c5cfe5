// Messages between the program and the process in which an FMU runs: packets of a local socket, one
// request, one reply. Both ends are of the same build. Internal.
#pragma once

#include <cstddef>
#include <cstdint>

namespace bentaxis::fmu::process {

enum class Task : std::uint32_t {
  load,         ///< texts: path of the library
  version,      ///< finds the functions and asks for the library's version of FMI
  instantiate,  ///< texts: name, token, resources
  set,          ///< items
  get,          ///< items
  set_up,       ///< start and end, s: FMI 2
  enter_initialisation,
  exit_initialisation,
  step,  ///< time and step, s
  terminate,
  free_instance,
  leave  ///< The process ends by exit(): no reply, but that of its supervisor.
};

/// Of a variable, as FMI 3 names it. Real, Integer and Boolean of FMI 2 are float64, int32,
/// boolean.
enum class Type : std::uint32_t {
  float64,
  float32,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  boolean
};

/// Followed by `items` of Item and by `text` bytes: strings, each ended by a zero.
struct Request {
  Task task;
  std::uint32_t version;  ///< of FMI
  double first, second;
  std::uint32_t items, text;
};
struct Item {
  Type type;
  std::uint32_t reference;
  double value;
};

enum class Outcome : std::uint32_t {
  returned,      ///< The call has returned: see `status`.
  not_loaded,    ///< text: why
  no_function,   ///< text: its name
  not_started,   ///< The FMU gives no instance.
  exception,     ///< A C++ exception came out of the FMU; text: its message.
  lost_channel,  ///< The FMU has closed the descriptor of this channel.
  // The following are said by the supervisor, once the process is no more.
  not_made,  ///< status: errno: there never was one
  exited,    ///< status: of exit()
  signalled  ///< status: the signal that ended or stopped it
};
/// Followed by `values` doubles, `text` bytes and `log` bytes: lines "3message", status of FMI
/// first, each ended by a newline.
struct Reply {
  Outcome outcome;
  std::int32_t status;
  std::uint32_t flags;  ///< of a step
  std::uint32_t index;  ///< of the item at which a call ended
  std::uint32_t values, text, log;
};
inline constexpr std::uint32_t kTerminates = 1;     ///< The FMU ends the simulation.
inline constexpr std::uint32_t kReturnedEarly = 2;  ///< without being allowed to
inline constexpr std::uint32_t kMaxItems = 1000;    ///< of a message
inline constexpr std::size_t kLargestMessage = 1U << 17;
inline constexpr std::size_t kMaxText = 1U << 15;  ///< bytes, of a request and of a reply
inline constexpr std::size_t kLongestLine = 400;   ///< of the log, letters

/// Exit status of a process that has lost its channel.
inline constexpr int kLostChannel = 113;
/// Descriptor of the channel in the process of an FMU, and of the supervisor's.
inline constexpr int kChannel = 3;

/// What the process of an FMU shares with its supervisor, which reads it when the process has
/// ended.
struct Shared {
  static constexpr std::size_t kLog = 1U << 15;
  std::uint32_t index;       ///< of the item that is being asked for
  std::uint32_t log_length;  ///< of what has been logged since the last reply
  char log[kLog];
};

}  // namespace bentaxis::fmu::process

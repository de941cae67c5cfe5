#include "channel.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::fmu {
namespace {

using process::Outcome;
using process::Reply;
using process::Request;

constexpr auto kLookEvery = std::chrono::milliseconds(100);
constexpr auto kTimeToDie = std::chrono::seconds(5);  // of a process that has been killed
constexpr double kShortTime = 1;                      // s
constexpr double kNoLimit = 1e8;                      // s: three years

// There is neither an answer nor a word of the supervisor.
struct Vanished {};

// How a process ended.
std::string end_in_words(const Returned& end) {
  std::string text;
  if (end.outcome == Outcome::not_made) {
    text = "no process can be started for the FMU: " + std::generic_category().message(end.status);
  } else if (end.outcome == Outcome::exited) {
    text = "the FMU ended its process, by exit status " + std::to_string(end.status);
  } else if (end.outcome == Outcome::lost_channel) {
    text = "the FMU closed the descriptor by which it is called";
  } else {
    const char* name = sigabbrev_np(end.status);
    const char* meaning = sigdescr_np(end.status);
    text = "the FMU ended by signal " +
           (name != nullptr ? "SIG" + std::string(name) : std::to_string(end.status)) +
           (meaning != nullptr ? " (" + std::string(meaning) + ")" : "");
    if (end.status == SIGKILL) text += ", raised by itself, from outside or because memory ran out";
  }
  const std::string said = said_last(end.log);
  if (!said.empty()) text += "; it logged: " + said;
  if (!end.text.empty()) text += "; it printed: " + end.text;
  return text;
}

}  // namespace

std::string said_last(const std::vector<std::string>& lines) {
  constexpr std::size_t kMax = 3;
  std::string text;
  for (std::size_t i = lines.size() - std::min(lines.size(), kMax); i < lines.size(); ++i)
    text += (text.empty() ? "" : "; ") + lines[i];
  return text;
}

Channel::Channel(Supervisor& supervisor, std::string fmu, const Limits& limits)
    : fmu_(std::move(fmu)), limits_(limits), channel_(supervisor.new_process()) {
  const auto micro = std::chrono::duration_cast<std::chrono::microseconds>(kLookEvery).count();
  const timeval look_every{0, static_cast<suseconds_t>(micro)};
  setsockopt(channel_, SOL_SOCKET, SO_RCVTIMEO, &look_every, sizeof look_every);
  packet_.resize(process::kLargestMessage);
}

Channel::~Channel() { close(); }

void Channel::close() {
  if (channel_ >= 0) ::close(channel_);
  channel_ = -1;
}

void Channel::fail(const std::string& what, const std::string& why) {
  close();
  throw ComputationError(fmu_ + ": " + what + ": " + why);
}

void Channel::hurry() {
  limits_.while_waiting = nullptr;
  limits_.call_seconds =
      limits_.call_seconds > 0 ? std::min(limits_.call_seconds, kShortTime) : kShortTime;
}

Returned Channel::call(const Call& call) {
  Returned returned = exchange(call);
  const std::string& what = call.names[std::min(returned.index, call.names.size() - 1)];
  switch (returned.outcome) {
    case Outcome::not_made:
    case Outcome::exited:
    case Outcome::signalled:
    case Outcome::lost_channel:
      fail(what, end_in_words(returned));
    case Outcome::exception:
      fail(what,
           "the FMU threw a C++ exception" + (returned.text.empty() ? "" : ": " + returned.text));
    default:
      return returned;
  }
}

void Channel::leave() {
  const Call end{process::Task::leave, {"the end of its process (exit handlers)"}};
  const Returned returned = exchange(end);
  if (returned.outcome != Outcome::exited || returned.status != 0)
    fail(end.names.front(), end_in_words(returned));
  close();
}

Returned Channel::exchange(const Call& call) {
  if (!idle()) throw ComputationError(fmu_ + ": " + call.names.front() + ": its process has ended");
  const double seconds = limits_.call_seconds > 0 ? limits_.call_seconds : kNoLimit;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::min(seconds, kNoLimit)));
  try {
    send(call);
    if (auto returned = receive_until(end, true)) return *returned;
    give_up_in_time(call);
  } catch (const Vanished&) {
    fail(call.names.front(), "the process of the FMU and the one that supervises it have ended");
  } catch (...) {
    close();
    throw;
  }
}

void Channel::send(const Call& call) {
  std::string texts;
  for (const std::string& text : call.texts) texts += text + '\0';
  if (texts.size() > process::kMaxText)
    throw InputError(fmu_ + ": " + call.names.front() + ": texts of " +
                     std::to_string(texts.size()) + " bytes: at most " +
                     std::to_string(process::kMaxText) + " are passed to an FMU");
  const Request request{call.task,
                        static_cast<std::uint32_t>(call.version),
                        call.first,
                        call.second,
                        static_cast<std::uint32_t>(call.items.size()),
                        static_cast<std::uint32_t>(texts.size())};
  std::string packet(reinterpret_cast<const char*>(&request), sizeof request);
  packet.append(reinterpret_cast<const char*>(call.items.data()),
                call.items.size() * sizeof(process::Item));
  packet += texts;
  while (::send(channel_, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) {
    if (errno == EINTR) continue;
    // It has ended between calls: its supervisor has said how.
    if (errno == EPIPE || errno == ECONNRESET) return;
    throw ComputationError(fmu_ + ": " + call.names.front() +
                           ": cannot be asked for: " + std::strerror(errno));
  }
}

std::optional<Returned> Channel::receive_until(Clock::time_point end, bool interruptible) {
  for (;;) {
    const ssize_t size = receiver_.receive(channel_, packet_.data(), packet_.size());
    if (size >= 0) {
      Returned returned;
      Reply head{};
      if (size == 0) throw Vanished();
      if (size < static_cast<ssize_t>(sizeof head)) {
        returned.outcome = Outcome::lost_channel;
        return returned;
      }
      std::memcpy(&head, packet_.data(), sizeof head);
      const std::uint64_t needed = sizeof head + std::uint64_t{head.values} * sizeof(double) +
                                   std::uint64_t{head.text} + std::uint64_t{head.log};
      if (needed != static_cast<std::uint64_t>(size) || head.outcome > Outcome::signalled) {
        returned.outcome = Outcome::lost_channel;
        return returned;
      }
      returned.outcome = head.outcome;
      returned.status = head.status;
      returned.flags = head.flags;
      returned.index = head.index;
      const char* at = packet_.data() + sizeof head;
      returned.values.resize(head.values);
      if (head.values > 0) std::memcpy(returned.values.data(), at, head.values * sizeof(double));
      at += head.values * sizeof(double);
      returned.text = plain_text({at, head.text}, process::kLongestLine);
      returned.log = log_lines({at + head.text, head.log});
      return returned;
    }
    if (errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) throw Vanished();
    if (interruptible && limits_.while_waiting) limits_.while_waiting();
    if (Clock::now() >= end) return std::nullopt;
  }
}

// The supervisor kills the process and says where it was.
void Channel::give_up_in_time(const Call& call) {
  shutdown(channel_, SHUT_WR);
  const auto end = receive_until(Clock::now() + kTimeToDie, false);
  const std::size_t index = end ? end->index : 0;
  std::string why = "the FMU has not returned after " + number_text(limits_.call_seconds) +
                    " s, the longest time that one call may take (--fmu-timeout)";
  if (end && !end->log.empty()) why += "; it logged: " + said_last(end->log);
  if (end && !end->text.empty()) why += "; it printed: " + end->text;
  fail(call.names[std::min(index, call.names.size() - 1)], why);
}

std::vector<std::string> log_lines(std::string_view text) {
  static const char* words[] = {"info", "warning", "discard", "error", "fatal"};
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const int status = end > 0 ? text[0] - '0' : -1;
    const std::string_view line = text.substr(end > 0 ? 1 : 0, end > 0 ? end - 1 : 0);
    lines.push_back(std::string(status >= 0 && status <= 4 ? words[status] : "unknown status") +
                    ": " + plain_text(line, process::kLongestLine));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace bentaxis::fmu

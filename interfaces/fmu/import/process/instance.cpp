#include "instance.h"

#include <dlfcn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "calls.h"
#include "receiver.h"

namespace bentaxis::fmu::process {
namespace {

// An answer in the making.
struct Answer {
  Reply reply{};
  std::vector<double> values;
  std::string text;
};

class Instance {
 public:
  explicit Instance(Shared& shared) : shared_(shared), log_(shared), process_(getpid()) {
    struct stat status {};
    fstat(kChannel, &status);
    channel_ = status.st_ino;
    packet_.resize(kLargestMessage);
  }

  [[noreturn]] void run() {
    for (;;) {
      const ssize_t size = receiver_.receive(kChannel, packet_.data(), packet_.size());
      if (size < 0 && errno == EINTR) continue;
      if (size < static_cast<ssize_t>(sizeof(Request))) leave(size == 0 ? 0 : kLostChannel);
      Answer answer;
      try {
        carry_out(answer);
      } catch (const std::exception& error) {
        answer.reply.outcome = Outcome::exception;
        answer.text = std::string(error.what()).substr(0, kLongestLine);
      }
      // A copy of this process that the FMU has made has come back, too.
      if (getpid() != process_) leave(0);
      send(answer);
    }
  }

 private:
  [[noreturn]] static void leave(int status) { _exit(status); }

  void carry_out(Answer& answer) {
    Request request{};
    std::memcpy(&request, packet_.data(), sizeof request);
    const char* at = packet_.data() + sizeof request;
    std::vector<Item> items(request.items);
    if (!items.empty()) std::memcpy(items.data(), at, items.size() * sizeof(Item));
    at += items.size() * sizeof(Item);
    const auto next_text = [&] {
      const char* text = at;
      at += std::strlen(at) + 1;
      return text;
    };
    Reply& reply = answer.reply;
    shared_.index = 0;
    switch (request.task) {
      case Task::load:
        library_ = dlopen(next_text(), RTLD_NOW | RTLD_LOCAL);
        if (library_ != nullptr) return;
        reply.outcome = Outcome::not_loaded;
        if (const char* why = dlerror(); why != nullptr)
          answer.text = std::string(why).substr(0, kLongestLine);
        return;
      case Task::version:
        calls_ = request.version == 2 ? fmi2_calls(library_, log_, answer.text)
                                      : fmi3_calls(library_, log_, answer.text);
        if (!calls_)
          reply.outcome = Outcome::no_function;
        else
          answer.text = calls_->version().substr(0, kLongestLine);
        return;
      case Task::instantiate: {
        const char* name = next_text();
        const char* token = next_text();
        if (!calls_->instantiate(name, token, next_text())) reply.outcome = Outcome::not_started;
        return;
      }
      case Task::set:
      case Task::get:
        for (Item& item : items) {
          reply.status = request.task == Task::set
                             ? calls_->set(item.type, item.reference, item.value)
                             : calls_->get(item.type, item.reference, item.value);
          if (reply.status != 0 && reply.status != 1) return;
          if (request.task == Task::get) answer.values.push_back(item.value);
          reply.index = ++shared_.index;
        }
        return;
      case Task::set_up:
        reply.status = calls_->set_up(request.first, request.second);
        return;
      case Task::enter_initialisation:
        reply.status = calls_->enter_initialisation(request.first, request.second);
        return;
      case Task::exit_initialisation:
        reply.status = calls_->exit_initialisation();
        return;
      case Task::step:
        reply.status = calls_->step(request.first, request.second, reply.flags);
        return;
      case Task::terminate:
        reply.status = calls_->terminate();
        return;
      case Task::free_instance:
        calls_->free_instance();
        return;
      case Task::leave:
        std::exit(0);  // runs what the FMU wants to be run at the end
    }
  }

  void send(Answer& answer) {
    // The FMU may have closed the channel, and opened something else in its place.
    struct stat status {};
    if (fstat(kChannel, &status) != 0 || status.st_ino != channel_ || !S_ISSOCK(status.st_mode))
      leave(kLostChannel);
    const std::string log = log_.take();
    Reply& reply = answer.reply;
    reply.values = static_cast<std::uint32_t>(answer.values.size());
    reply.text = static_cast<std::uint32_t>(answer.text.size());
    reply.log = static_cast<std::uint32_t>(log.size());
    std::string packet(reinterpret_cast<const char*>(&reply), sizeof reply);
    packet.append(reinterpret_cast<const char*>(answer.values.data()),
                  answer.values.size() * sizeof(double));
    packet += answer.text;
    packet += log;
    while (::send(kChannel, packet.data(), packet.size(), MSG_NOSIGNAL) < 0)
      if (errno != EINTR) leave(kLostChannel);
  }

  Shared& shared_;
  Log log_;
  pid_t process_;
  ino_t channel_ = 0;
  std::vector<char> packet_;
  Receiver receiver_;
  void* library_ = nullptr;
  std::unique_ptr<Calls> calls_;
};

}  // namespace

void run_instance(Shared& shared) {
  // For the whole life of the process, whatever exit() destroys.
  auto* instance = new Instance(shared);
  instance->run();
}

}  // namespace bentaxis::fmu::process

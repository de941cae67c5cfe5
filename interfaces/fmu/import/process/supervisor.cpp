// The program that supervises the processes of an FMU's instances. It is carried by the library,
// started once for each FMU that is opened, and runs no foreign code itself:
//
//   program ---- control ----> supervisor ----> process of an instance, of another, ..
//      \_______________ channel of an instance _______/
//
// The program sends the ends of channels over the control socket; for each the supervisor makes a
// process. It keeps the end too: once the process has ended, it says there how. Where the program
// closes a channel the process is killed; where it closes the control socket, or has ended, all
// processes are killed, with what they have started, and the folder of the FMU is removed.
//
//   fmu_supervisor FOLDER     (control socket: descriptor 3)
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "instance.h"
#include "messages.h"
#include "remove_tree.h"

namespace bentaxis::fmu::process {
namespace {

constexpr std::size_t kLastWords = 300;  // bytes of what a process has printed that are kept
constexpr int kLookEvery = 1000;         // ms: is the program still there
constexpr int kSweeps = 2500;            // each 2 ms: until all processes must have ended
constexpr rlim_t kLargestStack = rlim_t{1} << 30U;

// The process of an instance.
struct Child {
  pid_t process = 0;
  int channel = -1;  // the end of the process; the program has the other
  int output = -1;   // what it prints
  Shared* shared = nullptr;
  std::string printed;
  bool ended = false;
};

void close_all(Child& child) {
  if (child.channel >= 0) close(child.channel);
  if (child.output >= 0) close(child.output);
  child.channel = child.output = -1;
  if (child.shared != nullptr) munmap(child.shared, sizeof(Shared));
  child.shared = nullptr;
}

// The end of what has been printed is nearest to the reason.
void read_output(Child& child) {
  std::array<char, 4096> piece{};
  for (int pieces = 0; child.output >= 0 && pieces < 64; ++pieces) {
    const ssize_t size = read(child.output, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return;
    if (size == 0) {
      close(child.output);
      child.output = -1;
      return;
    }
    child.printed.append(piece.data(), static_cast<std::size_t>(size));
    if (child.printed.size() > kLastWords)
      child.printed.erase(0, child.printed.size() - kLastWords);
  }
}

void say_how_it_ended(Child& child, int status) {
  Reply reply{};
  if (WIFEXITED(status)) {
    const bool lost = WEXITSTATUS(status) == kLostChannel;
    reply.outcome = lost ? Outcome::lost_channel : Outcome::exited;
    reply.status = WEXITSTATUS(status);
  } else {
    reply.outcome = Outcome::signalled;
    reply.status = WIFSTOPPED(status) ? WSTOPSIG(status) : WTERMSIG(status);
  }
  reply.index = child.shared->index;
  reply.text = static_cast<std::uint32_t>(child.printed.size());
  reply.log = static_cast<std::uint32_t>(
      std::min<std::size_t>(child.shared->log_length, std::size_t{Shared::kLog}));
  std::string packet(reinterpret_cast<const char*>(&reply), sizeof reply);
  packet += child.printed;
  packet.append(child.shared->log, reply.log);
  send(child.channel, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

// Of the error that has just been met.
void say_there_is_none(int channel) {
  Reply reply{};
  reply.outcome = Outcome::not_made;
  reply.status = errno;
  send(channel, &reply, sizeof reply, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void kill_group(const Child& child) {
  kill(-child.process, SIGKILL);
  kill(child.process, SIGKILL);
}

// In the new process: nothing of the supervisor's is left but the channel.
[[noreturn]] void become_instance(int channel, int output, Shared& shared, pid_t supervisor) {
  setsid();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != supervisor) _exit(0);
  prctl(PR_SET_NAME, "fmu_instance");
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  dup2(channel, kChannel);
  fcntl(kChannel, F_SETFD, FD_CLOEXEC);
  close_range(kChannel + 1, ~0U, 0);
  // An endless recursion must not take all memory first.
  rlimit stack{};
  if (getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur > kLargestStack) {
    stack.rlim_cur = kLargestStack;
    setrlimit(RLIMIT_STACK, &stack);
  }
  // Where memory runs out, the FMU ends before the program.
  std::ofstream("/proc/self/oom_score_adj") << "500";
  run_instance(shared);
}

class Supervisor {
 public:
  explicit Supervisor(std::string folder) : folder_(std::move(folder)), program_(getppid()) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGUSR1, SIGUSR2})
      std::signal(signal, SIG_IGN);
    sigset_t ended;
    sigemptyset(&ended);
    sigaddset(&ended, SIGCHLD);
    sigprocmask(SIG_BLOCK, &ended, nullptr);
    signals_ = signalfd(-1, &ended, SFD_NONBLOCK | SFD_CLOEXEC);
    // What instances leave behind becomes a child of this process.
    prctl(PR_SET_CHILD_SUBREAPER, 1);
  }

  void run() {
    bool wanted = signals_ >= 0;
    while (wanted && getppid() == program_) {
      std::vector<pollfd> watched = {{kChannel, POLLIN, 0}, {signals_, POLLIN, 0}};
      for (const auto& child : children_) {
        watched.push_back({child->channel, POLLRDHUP, 0});
        watched.push_back({child->output, POLLIN, 0});
      }
      if (poll(watched.data(), watched.size(), kLookEvery) < 0 && errno != EINTR) break;
      for (std::size_t i = 0; i < children_.size(); ++i) {
        read_output(*children_[i]);
        if (watched[2 + 2 * i].revents != 0) kill_group(*children_[i]);  // not wanted any more
      }
      note_ended();
      if (watched[0].revents != 0) wanted = start();
    }
    for (const auto& child : children_) kill_group(*child);
    sweep();
    remove_tree(folder_);
  }

 private:
  // @return whether the program is still there
  bool start() {
    char byte = 0;
    iovec data{&byte, 1};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> space{};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = space.data();
    message.msg_controllen = space.size();
    const ssize_t size = recvmsg(kChannel, &message, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
    if (size < 0) return errno == EINTR || errno == EAGAIN;
    if (size == 0) return false;
    const cmsghdr* head = CMSG_FIRSTHDR(&message);
    if (head == nullptr || head->cmsg_type != SCM_RIGHTS) return true;
    auto child = std::make_unique<Child>();
    std::memcpy(&child->channel, CMSG_DATA(head), sizeof(int));
    std::array<int, 2> output{};
    void* shared =
        mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED || pipe2(output.data(), O_CLOEXEC) != 0) {
      say_there_is_none(child->channel);
      close(child->channel);
      return true;
    }
    child->shared = static_cast<Shared*>(shared);
    const pid_t supervisor = getpid();
    child->process = fork();
    if (child->process == 0) become_instance(child->channel, output[1], *child->shared, supervisor);
    if (child->process < 0) say_there_is_none(child->channel);
    close(output[1]);
    child->output = output[0];
    fcntl(child->output, F_SETFL, O_NONBLOCK);
    if (child->process < 0)
      close_all(*child);
    else
      children_.push_back(std::move(child));
    return true;
  }

  void note_ended() {
    signalfd_siginfo which{};
    while (read(signals_, &which, sizeof which) == static_cast<ssize_t>(sizeof which)) {
    }
    for (;;) {
      int status = 0;
      const pid_t process = waitpid(-1, &status, WNOHANG | WUNTRACED | __WALL);
      if (process <= 0) break;
      for (const auto& child : children_) {
        if (child->process != process || child->ended) continue;
        read_output(*child);
        say_how_it_ended(*child, status);
        kill_group(*child);
        child->ended = true;
      }
    }
    for (const auto& child : children_)
      if (child->ended) close_all(*child);
    children_.erase(std::remove_if(children_.begin(), children_.end(),
                                   [](const auto& child) { return child->ended; }),
                    children_.end());
  }

  // Until there is no process left.
  static void sweep() {
    for (int i = 0; i < kSweeps; ++i) {
      for (;;) {
        const pid_t process = waitpid(-1, nullptr, WNOHANG | __WALL);
        if (process < 0 && errno == ECHILD) return;
        if (process <= 0) break;
      }
      kill_children();
      usleep(2000);
    }
  }

  static void kill_children() {
    const std::string self = std::to_string(getpid());
    std::ifstream children("/proc/self/task/" + self + "/children");
    for (pid_t process = 0; children >> process;) kill(process, SIGKILL);
  }

  std::string folder_;
  pid_t program_;
  int signals_ = -1;
  std::vector<std::unique_ptr<Child>> children_;
};

}  // namespace
}  // namespace bentaxis::fmu::process

int main(int count, char** arguments) {
  if (count != 2) return 2;
  bentaxis::fmu::process::Supervisor(arguments[1]).run();
  return 0;
}

#include "supervisor.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "bentaxis/pump/error.h"
#include "embedded.h"
#include "process/messages.h"

namespace bentaxis::fmu {
namespace {

constexpr int kLongestEnd = 10000;  // ms, for all processes to end
// Another thread that starts a program at this moment holds the file open for writing until it
// does.
constexpr int kBusyTries = 200, kBusyWait = 5000;  // us

std::string error_text(int number) { return std::generic_category().message(number); }

// Arguments of posix_spawn().
class SpawnArguments {
 public:
  explicit SpawnArguments(int control) {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&files, standard, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&files, control, process::kChannel);
    posix_spawn_file_actions_addclosefrom_np(&files, process::kChannel + 1);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnArguments() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnArguments(const SpawnArguments&) = delete;
  SpawnArguments& operator=(const SpawnArguments&) = delete;

  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
};

// A pair of connected sockets above the standard descriptors, which the supervisor opens anew.
bool make_pair(std::array<int, 2>& ends) {
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return false;
  for (int& end : ends) {
    if (end > process::kChannel) continue;
    const int higher = fcntl(end, F_DUPFD_CLOEXEC, process::kChannel + 1);
    close(end);
    end = higher;
  }
  return ends[0] >= 0 && ends[1] >= 0;
}

}  // namespace

Supervisor::Supervisor(const std::filesystem::path& folder, std::string fmu)
    : fmu_(std::move(fmu)) {
  const std::string program = (folder / "fmu_supervisor").string();
  write_program(program);
  std::array<int, 2> ends{};
  if (!make_pair(ends)) fail(error_text(errno));
  control_ = ends[0];
  std::string place = folder.string(), name = program;
  const std::array<char*, 3> arguments = {name.data(), place.data(), nullptr};
  int error = ETXTBSY;
  {
    const SpawnArguments how(ends[1]);
    for (int i = 0; i < kBusyTries && error == ETXTBSY; ++i) {
      error = posix_spawn(&process_, program.c_str(), &how.files, &how.attributes, arguments.data(),
                          environ);
      if (error == ETXTBSY) usleep(kBusyWait);
    }
  }
  close(ends[1]);
  if (error == 0) return;
  close(control_);
  fail(program + ": " + error_text(error) +
       (error == EACCES ? ": the file system of the folder for temporary files (TMPDIR) must allow "
                          "programs to be run"
                        : ""));
}

Supervisor::~Supervisor() {
  shutdown(control_, SHUT_WR);
  // Its end closes the socket. Nothing that an FMU does keeps it from that.
  pollfd ended{control_, 0, 0};
  int polled = -1;
  do {
    polled = poll(&ended, 1, kLongestEnd);
  } while (polled < 0 && errno == EINTR);
  if (polled == 0) kill(process_, SIGKILL);
  close(control_);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Supervisor::fail(const std::string& why) const {
  throw ComputationError(fmu_ + ": no process can be started for this FMU: " + why);
}

void Supervisor::write_program(const std::filesystem::path& file) const {
  const std::string_view program = embedded_supervisor();
  constexpr mode_t kOwnerRunsIt = 0500;
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerRunsIt);
  std::size_t written = 0;
  while (out >= 0 && written < program.size()) {
    const ssize_t size = write(out, program.data() + written, program.size() - written);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    written += static_cast<std::size_t>(size);
  }
  const int error = errno;
  if ((out >= 0 && close(out) == 0) && written == program.size()) return;
  fail(file.string() + ": " + error_text(error));
}

int Supervisor::new_process() {
  std::array<int, 2> ends{};
  if (!make_pair(ends)) fail(error_text(errno));
  char byte = 0;
  iovec data{&byte, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> space{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = space.data();
  message.msg_controllen = space.size();
  cmsghdr* head = CMSG_FIRSTHDR(&message);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(head), &ends[1], sizeof(int));
  ssize_t sent = -1;
  {
    const std::lock_guard<std::mutex> lock(busy_);
    do {
      sent = sendmsg(control_, &message, MSG_NOSIGNAL);
    } while (sent < 0 && errno == EINTR);
  }
  const int error = errno;
  close(ends[1]);
  if (sent >= 0) return ends[0];
  close(ends[0]);
  fail(error == EPIPE ? "the process that supervises it has ended" : error_text(error));
}

}  // namespace bentaxis::fmu

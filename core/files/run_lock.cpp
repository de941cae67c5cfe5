#include "bentaxis/files/run_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace fs = std::filesystem;
namespace {

// "process 4711 on host", as the holder wrote it.
std::string holder_in(int handle) {
  char text[200] = "";
  const ssize_t size = pread(handle, text, sizeof text - 1, 0);
  const std::string holder(text, size > 0 ? static_cast<std::size_t>(size) : 0);
  return holder.substr(0, holder.find('\n'));
}

void write_holder(int handle) {
  char host[65] = "";
  gethostname(host, sizeof host - 1);
  const std::string text = "process " + std::to_string(getpid()) + " on " + host + "\n";
  // For the message alone: the lock holds without it.
  if (ftruncate(handle, 0) != 0 || pwrite(handle, text.data(), text.size(), 0) < 0) return;
}

}  // namespace

RunLock::RunLock(fs::path file, Kind kind, const std::string& work) : file_(std::move(file)) {
  while (!take(kind, work)) continue;
}

RunLock::RunLock(RunLock&& other) noexcept
    : file_(std::move(other.file_)),
      handle_(std::exchange(other.handle_, -1)),
      alone_(other.alone_) {}

RunLock::~RunLock() {
  if (handle_ < 0) return;
  // Nobody else holds it then, and whoever waits for it sees that it is gone. One that was shared
  // stays: to take it away it would have to be held alone, and others would be refused meanwhile.
  if (alone_ && is_in_place()) unlink(file_.c_str());
  close(handle_);
}

bool RunLock::is_in_place() const {
  struct stat mine = {}, there = {};
  return fstat(handle_, &mine) == 0 && stat(file_.c_str(), &there) == 0 &&
         mine.st_ino == there.st_ino && mine.st_dev == there.st_dev;
}

// False: the file was removed by its last holder meanwhile; again.
bool RunLock::take(Kind kind, const std::string& work) {
  if (kind == Kind::reader) {
    handle_ = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle_ < 0) return true;
  } else {
    std::error_code ignored;
    fs::create_directories(file_.parent_path(), ignored);
    handle_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (handle_ < 0)
      throw InputError(file_.string() + ": cannot be written: " + std::strerror(errno));
  }
  const bool held = flock(handle_, (kind == Kind::alone ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0;
  if (!held && errno == EWOULDBLOCK) {
    const std::string holder = holder_in(handle_);
    close(std::exchange(handle_, -1));
    throw InputError(file_.parent_path().string() + ": another " + work +
                     " is running in this directory" + (holder.empty() ? "" : " (" + holder + ")") +
                     "; wait until it has ended, or choose another --out");
  }
  if (held && !is_in_place()) {
    close(std::exchange(handle_, -1));
    return false;
  }
  alone_ = held && kind == Kind::alone;
  if (alone_) write_holder(handle_);
  return true;
}

}  // namespace bentaxis

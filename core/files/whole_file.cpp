#include "bentaxis/files/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace fs = std::filesystem;
namespace {

// 0, or the error's number.
int write_all(int handle, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(handle, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

void write_whole(const fs::path& file, const std::string& content) {
  static std::atomic<unsigned> count = 0;
  char host[65] = "";
  gethostname(host, sizeof host - 1);
  const fs::path temporary = file.string() + "." + host + "-" + std::to_string(getpid()) + "-" +
                             std::to_string(count++) + kUnfinished;
  const int handle = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  int error = handle < 0 ? errno : write_all(handle, content);
  if (handle >= 0 && close(handle) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return;
  if (handle >= 0) unlink(temporary.c_str());
  throw InputError(file.string() + ": cannot be written: " + std::strerror(error));
}

}  // namespace bentaxis

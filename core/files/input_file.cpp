#include "bentaxis/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw InputError(file.string() + ": " + why);
}

class Handle {
 public:
  // Opening a pipe or a device without O_NONBLOCK may wait for ever.
  explicit Handle(const std::filesystem::path& file)
      : number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
  ~Handle() {
    if (number_ >= 0) ::close(number_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

std::string size_text(std::uint64_t bytes) {
  return rounded_text(static_cast<double>(bytes) / kMebibyte, 4) + " MiB";
}

std::string content_of(int handle, const std::filesystem::path& file, const InputKind& kind) {
  struct stat facts {};
  if (::fstat(handle, &facts) != 0) fail(file, "cannot be read: " + std::string(strerror(errno)));
  const std::string name = kind.name;
  if (S_ISDIR(facts.st_mode)) fail(file, "is a directory, not " + name);
  if (!S_ISREG(facts.st_mode))
    fail(file, std::string(S_ISFIFO(facts.st_mode)   ? "is a pipe"
                           : S_ISSOCK(facts.st_mode) ? "is a socket"
                                                     : "is a device") +
                   ": " + name + " must be a regular file");
  const auto too_large = [&](const std::string& size) {
    fail(file, size + ": " + name + " must have at most " + size_text(kind.largest));
  };
  if (static_cast<std::uint64_t>(facts.st_size) > kind.largest)
    too_large("has " + size_text(static_cast<std::uint64_t>(facts.st_size)));
  std::string content;
  content.reserve(static_cast<std::size_t>(facts.st_size));
  // To its end and not to the size it says: a file may grow, and some of the system say 0.
  std::array<char, 1U << 16U> piece;
  for (;;) {
    const ssize_t count = ::read(handle, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file, "cannot be read: " + std::string(strerror(errno)));
    if (count == 0) return content;
    content.append(piece.data(), static_cast<std::size_t>(count));
    if (content.size() > kind.largest) too_large("is larger than its size says");
  }
}

}  // namespace

std::string read_input_file(const std::filesystem::path& file, const InputKind& kind) {
  const Handle handle(file);
  if (handle.number() < 0) {
    if (errno == ENXIO)
      fail(file, "is a socket or a device: " + std::string(kind.name) + " must be a regular file");
    fail(file, "cannot be read: no such file, or no permission");
  }
  return content_of(handle.number(), file, kind);
}

std::optional<std::string> read_input_file_if_there(const std::filesystem::path& file,
                                                    const InputKind& kind) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  return read_input_file(file, kind);
}

}  // namespace bentaxis

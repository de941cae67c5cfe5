#include "calls.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>

namespace bentaxis::fmu::process {

void Log::add(int status, const char* message) noexcept {
  try {
    const std::lock_guard<std::mutex> lock(busy_);
    char line[kLongestLine + 4];
    std::size_t length = 0;
    line[length++] = static_cast<char>('0' + std::clamp(status, 0, 9));
    const std::size_t letters = message != nullptr ? strnlen(message, kLongestLine + 1) : 0;
    std::size_t kept = std::min(letters, kLongestLine);
    if (letters > kept)  // not within a character
      while (kept > 0 && (static_cast<unsigned char>(message[kept]) & 0xC0U) == 0x80) --kept;
    for (std::size_t i = 0; i < kept; ++i)
      line[length++] = static_cast<unsigned char>(message[i]) < ' ' ? ' ' : message[i];
    while (length > 1 && line[length - 1] == ' ') --length;
    if (letters > kLongestLine) {
      line[length++] = '.';
      line[length++] = '.';
    }
    line[length++] = '\n';
    std::uint32_t& filled = shared_.log_length;
    if (filled + length > Shared::kLog) filled = 0;
    std::memcpy(shared_.log + filled, line, length);
    filled += static_cast<std::uint32_t>(length);
  } catch (...) {  // A lock that fails: the line is lost.
  }
}

std::string Log::take() {
  const std::lock_guard<std::mutex> lock(busy_);
  std::string lines(shared_.log,
                    std::min<std::size_t>(shared_.log_length, std::size_t{Shared::kLog}));
  shared_.log_length = 0;
  return lines;
}

void* symbol(void* library, const char* name) { return dlsym(library, name); }

}  // namespace bentaxis::fmu::process

#include "bentaxis/files/input_log.h"

#include <nettle/sha2.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>

#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace {

struct Log {
  std::mutex mutex;
  std::optional<std::vector<InputFile>> files;  // while it is kept
};

Log& the_log() {
  static Log log;
  return log;
}

}  // namespace

InputLog::InputLog() {
  const std::lock_guard lock(the_log().mutex);
  the_log().files.emplace();
}

InputLog::~InputLog() {
  const std::lock_guard lock(the_log().mutex);
  the_log().files.reset();
}

std::vector<InputFile> InputLog::files() {
  const std::lock_guard lock(the_log().mutex);
  return the_log().files.value_or(std::vector<InputFile>());
}

void InputLog::note(const std::filesystem::path& file) {
  {
    const std::lock_guard lock(the_log().mutex);
    if (!the_log().files) return;
  }
  try {
    note(file, read_input_file(file, {"an input file", kLargestReport}));
  } catch (const InputError&) {  // it has gone since it was read
  }
}

void InputLog::note(const std::filesystem::path& file, const std::string& content) {
  const std::lock_guard lock(the_log().mutex);
  auto& files = the_log().files;
  if (!files) return;
  const InputFile read{file, sha256_of(content)};
  const bool known = std::any_of(files->begin(), files->end(), [&](const InputFile& other) {
    return other.file == read.file && other.sha256 == read.sha256;
  });
  if (!known) files->push_back(read);
}

std::string sha256_of(const std::string& bytes) {
  sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  sha256_digest(&context, digest.size(), digest.data());
  std::string text;
  for (const std::uint8_t byte : digest) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0xFU];
  }
  return text;
}

}  // namespace bentaxis

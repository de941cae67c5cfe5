#include "bentaxis/files/input_log.h"

#include <nettle/sha2.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace {

struct OpenLogs {
  std::mutex mutex;
  std::vector<InputLog*> logs;  // in the order in which they were made
};

OpenLogs& open_logs() {
  static OpenLogs open;
  return open;
}

}  // namespace

InputLog::InputLog(Threads threads) : threads_(threads) {
  const std::lock_guard lock(open_logs().mutex);
  open_logs().logs.push_back(this);
}

InputLog::~InputLog() {
  const std::lock_guard lock(open_logs().mutex);
  std::erase(open_logs().logs, this);
}

bool InputLog::listens() const {
  return threads_ == Threads::all || owner_ == std::this_thread::get_id();
}

std::vector<InputFile> InputLog::noted() const {
  const std::lock_guard lock(open_logs().mutex);
  return files_;
}

std::vector<InputFile> InputLog::files() {
  const std::lock_guard lock(open_logs().mutex);
  const auto& logs = open_logs().logs;
  const auto last =
      std::find_if(logs.rbegin(), logs.rend(), [](const InputLog* log) { return log->listens(); });
  return last == logs.rend() ? std::vector<InputFile>() : (*last)->files_;
}

void InputLog::note(const std::filesystem::path& file, const std::string& content) {
  {
    const std::lock_guard lock(open_logs().mutex);
    if (open_logs().logs.empty()) return;  // hashing takes time
  }
  note(InputFile{file, sha256_of(content)});
}

void InputLog::note(const InputFile& read) {
  const std::lock_guard lock(open_logs().mutex);
  for (InputLog* const log : open_logs().logs) {
    if (!log->listens()) continue;
    auto& files = log->files_;
    const bool known = std::any_of(files.begin(), files.end(), [&](const InputFile& other) {
      return other.file == read.file && other.sha256 == read.sha256;
    });
    if (!known) files.push_back(read);
  }
}

void InputLog::note(const std::filesystem::path& file) {
  try {
    note(file, read_input_file(file, {"an input file", kLargestReport}));
  } catch (const InputError&) {  // it has gone since it was read
  }
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

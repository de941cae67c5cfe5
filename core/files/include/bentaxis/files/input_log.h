// Which files a program has read, and what was in them.
#pragma once

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "bentaxis/pump/case.h"

namespace bentaxis {

/// While one of these exists the readers of this module note in it each file they have read. Logs
/// may be nested and may exist in several threads at once: each keeps its own entries.
class InputLog {
 public:
  /// Whose files are noted.
  enum class Threads { all, own };
  explicit InputLog(Threads threads = Threads::all);
  ~InputLog();
  InputLog(const InputLog&) = delete;
  InputLog& operator=(const InputLog&) = delete;

  /// In the order in which they were read first.
  std::vector<InputFile> noted() const;
  /// Of the log made last that notes what this thread reads; none without such a log.
  static std::vector<InputFile> files();

  /// For readers: notes a file in every log that notes what this thread reads, once for each
  /// content it was found with.
  /// @param content  the bytes that were read
  static void note(const std::filesystem::path& file, const std::string& content);
  /// The same of a file that was read earlier.
  static void note(const InputFile& read);
  [[deprecated("reads the file again, which may have changed: note what was read")]] static void
  note(const std::filesystem::path& file);

 private:
  bool listens() const;

  const Threads threads_;
  const std::thread::id owner_ = std::this_thread::get_id();
  std::vector<InputFile> files_;
};

/// SHA-256 (FIPS 180-4) of a text's bytes, 64 hexadecimal digits.
std::string sha256_of(const std::string& bytes);

}  // namespace bentaxis

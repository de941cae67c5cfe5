// Which files a program has read, and what was in them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bentaxis {

struct InputFile {
  std::filesystem::path file;  ///< as it was named
  std::string sha256;          ///< of its bytes: 64 hexadecimal digits
};

/// While one of these exists the readers of this room note each file they have read; without one
/// they do not. One at a time.
class InputLog {
 public:
  InputLog();
  ~InputLog();
  InputLog(const InputLog&) = delete;
  InputLog& operator=(const InputLog&) = delete;

  /// In the order in which they were read first.
  static std::vector<InputFile> files();
  /// For readers: notes a file, once for each content it was found with. Without a content it is
  /// read for that; what cannot be read is not noted.
  static void note(const std::filesystem::path& file);
  static void note(const std::filesystem::path& file, const std::string& content);
};

/// SHA-256 (FIPS 180-4) of a text's bytes, 64 hexadecimal digits.
std::string sha256_of(const std::string& bytes);

}  // namespace bentaxis

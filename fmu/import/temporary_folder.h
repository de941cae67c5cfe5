// A folder that goes with its owner. Internal.
#pragma once

#include <filesystem>

namespace bentaxis::fmu {

class TemporaryFolder {
 public:
  /// Makes a folder of its own in that of temporary files (TMPDIR).
  /// @throws InputError where it cannot be made
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }  ///< absolute

 private:
  std::filesystem::path path_;
};

}  // namespace bentaxis::fmu

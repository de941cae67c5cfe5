// Where files wait until they are complete.
#pragma once

#include <filesystem>
#include <string>

namespace bentaxis {

/// A hidden folder that belongs to one run. The run holds a lock on it, which the system releases
/// when the process ends, also when it is killed: a later run can tell what was left behind from
/// what is still in use. Where the file system has no locks, nothing is taken for left behind.
class StagingFolder {
 public:
  /// Makes PARENT/PREFIX followed by the number of the process and a count.
  /// @param parent  must be there
  /// @throws std::filesystem::filesystem_error where it cannot be made
  StagingFolder(const std::filesystem::path& parent, const std::string& prefix);
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;
  /// Removes the folder with all that is in it.
  ~StagingFolder();

  const std::filesystem::path& path() const { return path_; }

  /// Removes the folders of this prefix in a folder that no process holds any more.
  static void remove_abandoned(const std::filesystem::path& parent,
                               const std::string& prefix) noexcept;

 private:
  std::filesystem::path path_;
  int handle_ = -1;
};

}  // namespace bentaxis

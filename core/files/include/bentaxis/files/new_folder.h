// A folder that appears whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bentaxis/files/staging_folder.h"

namespace bentaxis {

/// Collects the files of a new folder beside it, under a temporary name, and puts them in place at
/// the end. Without that nothing is left; what a killed run has left is removed by the next one.
class NewFolder {
 public:
  /// @throws InputError where there is something already: a folder that is empty will do
  explicit NewFolder(std::filesystem::path folder);
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  /// Where its files are until then.
  const std::filesystem::path& here() const { return staging_->path(); }
  /// Writes a file, by its path within the folder. @throws InputError
  void add(const std::filesystem::path& name, const std::string& content);
  /// @throws InputError
  void commit();

 private:
  std::string prefix() const;
  void fill();

  std::filesystem::path folder_;
  std::optional<StagingFolder> staging_;
};

}  // namespace bentaxis

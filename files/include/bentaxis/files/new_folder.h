// A folder that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace bentaxis {

/// Collects the files of a new folder beside it, under a temporary name, and puts them in place at
/// the end. Without that nothing is left.
class NewFolder {
 public:
  /// @throws InputError where there is something already: a folder that is empty will do
  explicit NewFolder(std::filesystem::path folder);
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder();

  /// Where its files are until then.
  const std::filesystem::path& here() const { return here_; }
  /// Writes a file, by its path within the folder. @throws InputError
  void add(const std::filesystem::path& name, const std::string& content);
  /// @throws InputError
  void commit();

 private:
  std::filesystem::path folder_, here_;
};

}  // namespace bentaxis

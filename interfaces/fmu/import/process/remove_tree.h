// Removal of the folder of an unpacked FMU, for the program and the supervisor. Internal.
#pragma once

#include <filesystem>

namespace bentaxis::fmu::process {

/// Removes a folder with all that is in it, also where an FMU has taken the permissions away. What
/// is not there is no error.
inline void remove_tree(const std::filesystem::path& folder) noexcept {
  namespace fs = std::filesystem;
  std::error_code failed;
  fs::remove_all(folder, failed);
  if (!failed) return;
  const auto allow = [&failed](const fs::path& path) {
    fs::permissions(path, fs::perms::owner_all, fs::perm_options::add, failed);
  };
  try {
    allow(folder);
    fs::recursive_directory_iterator entries(folder, failed), end;
    while (entries != end) {
      if (entries->symlink_status(failed).type() == fs::file_type::directory)
        allow(entries->path());  // before it is entered
      entries.increment(failed);
      if (failed) break;
    }
  } catch (...) {  // No memory: some of it stays.
  }
  fs::remove_all(folder, failed);
}

}  // namespace bentaxis::fmu::process

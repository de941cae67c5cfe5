#include "bentaxis/files/staging_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

namespace bentaxis {
namespace fs = std::filesystem;
namespace {

int open_folder(const fs::path& folder) {
  return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

// Whether a folder was removed since it was opened.
bool is_removed(int handle) {
  struct stat facts = {};
  return fstat(handle, &facts) != 0 || facts.st_nlink == 0;
}

}  // namespace

StagingFolder::StagingFolder(const fs::path& parent, const std::string& prefix) {
  static std::atomic<unsigned> count = 0;
  for (;;) {
    path_ = parent / (prefix + std::to_string(getpid()) + "-" + std::to_string(count++));
    if (!fs::create_directory(path_)) continue;  // of another machine's process of this number
    // Another run may take it for abandoned before it is opened or locked: then a new one is made.
    handle_ = open_folder(path_);
    if (handle_ < 0 && errno == ENOENT) continue;
    if (handle_ < 0) break;
    const bool locked = flock(handle_, LOCK_EX | LOCK_NB) == 0;
    const bool lost = locked ? is_removed(handle_) : errno == EWOULDBLOCK;
    if (!lost) break;
    close(handle_);
    handle_ = -1;
  }
}

StagingFolder::~StagingFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (handle_ >= 0) close(handle_);
}

void StagingFolder::remove_abandoned(const fs::path& parent, const std::string& prefix) noexcept {
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(parent)) {
      if (!entry.path().filename().string().starts_with(prefix)) continue;
      const int handle = open_folder(entry.path());
      if (handle < 0) continue;
      std::error_code ignored;
      if (flock(handle, LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry.path(), ignored);
      close(handle);
    }
  } catch (const std::exception&) {
    // What cannot be listed or removed stays; the results are there.
    return;
  }
}

}  // namespace bentaxis

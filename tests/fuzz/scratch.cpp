#include "scratch.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace bentaxis::fuzz {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "bentaxis_fuzz_XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr, "no scratch folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

fs::path file_with(const std::uint8_t* data, std::size_t size) {
  static const int handle = memfd_create("fuzz", 0);
  require(handle >= 0 && ftruncate(handle, 0) == 0, "no scratch file");
  require(pwrite(handle, data, size, 0) == static_cast<ssize_t>(size), "scratch file not written");
  return "/proc/self/fd/" + std::to_string(handle);
}

const fs::path& scratch_folder() {
  static const Folder folder;
  return folder.path();
}

fs::path named_file_with(const std::string& name, const std::uint8_t* data, std::size_t size) {
  const fs::path file = file_with(data, size);
  fs::path link = scratch_folder() / name;
  if (!fs::is_symlink(link)) fs::create_symlink(file, link);
  return link;
}

void check_message(const std::exception& error) {
  const std::string what = error.what();
  require(!what.empty(), "message is empty");
  require(what.find('\n') == std::string::npos, "message has more than one line");
}

}  // namespace bentaxis::fuzz

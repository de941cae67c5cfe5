#include "bentaxis/files/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be written: " + why);
}

// Keeps other programs from putting files in place in a folder meanwhile. Best effort: where locks
// are not supported each file is still whole.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder) : handle_(::open(folder.c_str(), O_RDONLY)) {
    if (handle_ >= 0) flock(handle_, LOCK_EX);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (handle_ >= 0) close(handle_);
  }

 private:
  int handle_;
};

}  // namespace

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  if (folder_.empty()) fail("\"\"", "an output folder needs a name");
  fs::path missing = fs::absolute(folder_, error).lexically_normal();
  if (missing.filename().empty()) missing = missing.parent_path();
  while (!missing.empty() && !fs::exists(missing, error)) {
    created_ = missing;
    missing = missing.parent_path();
  }
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_)) {
    created_.clear();
    fail(folder_, error ? error.message() : "is not a folder");
  }
  if (access(folder_.c_str(), W_OK | X_OK) != 0) fail(folder_, std::strerror(errno));
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (const auto& [temporary, final_path] : pending_) fs::remove(temporary, ignored);
  if (created_.empty()) return;
  // A folder made for a run that produced nothing goes too, unless somebody else put something in.
  fs::path folder = fs::absolute(folder_, ignored).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  while (fs::remove(folder, ignored) && folder != created_) folder = folder.parent_path();
}

void OutputFolder::Stream::write(const std::string& piece) {
  if (std::fwrite(piece.data(), 1, piece.size(), file_.get()) != piece.size())
    fail(shown_, std::strerror(errno));
}

void OutputFolder::Stream::finish() {
  if (!file_) return;
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0)
    fail(shown_, std::strerror(errno));
  if (std::fclose(file_.release()) != 0) fail(shown_, std::strerror(errno));
}

OutputFolder::Stream& OutputFolder::open(const std::string& name) {
  const fs::path final_path = folder_ / name;
  const fs::path temporary = folder_ / ("." + name + ".part-" + std::to_string(getpid()));
  auto stream = std::make_unique<Stream>();
  stream->shown_ = final_path;
  stream->file_.reset(std::fopen(temporary.c_str(), "wb"));
  if (!stream->file_) fail(final_path, std::strerror(errno));
  pending_.emplace_back(temporary, final_path);
  streams_.push_back(std::move(stream));
  return *streams_.back();
}

void OutputFolder::add(const std::string& name, const std::string& content) {
  Stream& stream = open(name);
  stream.write(content);
  stream.finish();
}

std::vector<fs::path> OutputFolder::commit() {
  for (const auto& stream : streams_) stream->finish();
  const FolderLock lock(folder_);
  for (const auto& [temporary, final_path] : pending_)
    if (fs::is_directory(final_path)) fail(final_path, "is a folder");
  std::vector<fs::path> paths;
  for (const auto& [temporary, final_path] : pending_) {
    std::error_code error;
    fs::rename(temporary, final_path, error);
    if (error) fail(final_path, error.message());
    paths.push_back(final_path);
  }
  pending_.clear();
  created_.clear();
  return paths;
}

}  // namespace bentaxis

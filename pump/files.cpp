#include "bentaxis/pump/files.h"

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

void write_whole(const fs::path& temporary, const fs::path& shown, const std::string& content) {
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) fail(shown, std::strerror(errno));
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  int error = written ? 0 : errno;
  if (error == 0 && (std::fflush(file) != 0 || fsync(fileno(file)) != 0)) error = errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;
  if (error != 0) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(shown, std::strerror(error));
  }
}

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
  // Folders made for a run that produced nothing go too, unless someone else has put something
  // there.
  if (created_.empty()) return;
  fs::path folder = fs::absolute(folder_, ignored).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  while (fs::remove(folder, ignored) && folder != created_) folder = folder.parent_path();
}

void OutputFolder::add(const std::string& name, const std::string& content) {
  const fs::path final_path = folder_ / name;
  const fs::path temporary = folder_ / ("." + name + ".part-" + std::to_string(getpid()));
  pending_.emplace_back(temporary, final_path);
  write_whole(temporary, final_path, content);
}

std::vector<fs::path> OutputFolder::commit() {
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

#include "bentaxis/files/new_folder.h"

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(path.string() + ": " + why);
}

}  // namespace

NewFolder::NewFolder(fs::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) throw InputError("the new directory needs a name");
  std::error_code error;
  const fs::path full = fs::absolute(folder_).lexically_normal();
  const fs::path place = full.has_filename() ? full : full.parent_path();
  if (fs::is_symlink(place, error)) refuse(folder_, "is a link; name the directory itself");
  if (fs::exists(place, error)) {
    if (!fs::is_directory(place, error)) refuse(folder_, "exists and is not a directory");
    if (!fs::is_empty(place, error)) refuse(folder_, "exists and is not empty");
  } else if (!fs::is_directory(place.parent_path(), error)) {
    refuse(place.parent_path(), "the directory does not exist");
  }
  folder_ = place;
  try {
    staging_.emplace(place.parent_path(), prefix());
  } catch (const fs::filesystem_error& failed) {
    refuse(place.parent_path(), "the directory is not writable: " + failed.code().message());
  }
}

std::string NewFolder::prefix() const { return "." + folder_.filename().string() + ".part-"; }

void NewFolder::add(const fs::path& name, const std::string& content) {
  std::error_code error;
  fs::create_directories((here() / name).parent_path(), error);
  std::ofstream out(here() / name, std::ios::binary);
  out << content;
  out.close();
  if (!out)
    refuse(folder_ / name,
           "cannot be written: " + std::error_code(errno, std::generic_category()).message());
}

void NewFolder::commit() {
  std::error_code error;
  if (fs::exists(folder_, error)) {
    fill();
  } else {
    fs::rename(here(), folder_, error);
    if (error) refuse(folder_, "cannot be created: " + error.message());
  }
  StagingFolder::remove_abandoned(folder_.parent_path(), prefix());
}

// It is there and empty, and may be where somebody stands: it stays, and is filled.
void NewFolder::fill() {
  std::error_code error;
  std::vector<fs::path> moved;
  for (const fs::directory_entry& entry : fs::directory_iterator(here())) {
    const fs::path to = folder_ / entry.path().filename();
    fs::rename(entry.path(), to, error);
    if (error) {
      for (const fs::path& path : moved) fs::remove_all(path);
      refuse(folder_, "cannot be filled: " + error.message());
    }
    moved.push_back(to);
  }
}

}  // namespace bentaxis

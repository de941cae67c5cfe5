#include "bentaxis/files/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStaging = ".bentaxis.part-";

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
  if (folder_.empty()) fail("\"\"", "an output directory needs a name");
  if (folder_ == "-")
    fail(folder_,
         "is not a directory; results are written to files in a directory (for one called - write "
         "./-)");
  fs::path missing = fs::absolute(folder_, error).lexically_normal();
  if (missing.filename().empty()) missing = missing.parent_path();
  while (!missing.empty() && !fs::exists(missing, error)) {
    created_ = missing;
    missing = missing.parent_path();
  }
  fs::create_directories(folder_, error);
  if (error) {  // of a file in its place too
    created_.clear();
    fail(folder_, error.message());
  }
  if (::access(folder_.c_str(), W_OK | X_OK) != 0) fail(folder_, std::strerror(errno));
}

OutputFolder::~OutputFolder() {
  streams_.clear();
  staging_.reset();
  if (created_.empty()) return;
  std::error_code ignored;
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

void OutputFolder::Stream::expect(double bytes) const {
  std::error_code error;
  const auto space = fs::space(shown_.parent_path().empty() ? "." : shown_.parent_path(), error);
  if (error || bytes <= static_cast<double>(space.available)) return;
  const auto free = static_cast<double>(space.available);
  const auto [unit, name] =
      free < 1e9 && bytes < 1e9 ? std::pair{1e6, " MB"} : std::pair{1e9, " GB"};
  fail(shown_, "takes about " + number_text(std::ceil(10 * bytes / unit) / 10) + name +
                   " of disk, and " + number_text(std::floor(10 * free / unit) / 10) + name +
                   " are free");
}

fs::path OutputFolder::reserve(const std::string& name) {
  try {
    if (!staging_) {
      fs::create_directories(folder_);  // a run that failed meanwhile may have taken it along
      staging_.emplace(folder_, kStaging);
    }
  } catch (const fs::filesystem_error& error) {
    fail(folder_, error.code().message());
  }
  // No ending by which others know a result.
  pending_.push_back(
      {staging_->path() / (name + ".new"), folder_ / name, staging_->path() / (name + ".before")});
  return pending_.back().temporary;
}

OutputFolder::Stream& OutputFolder::open(const std::string& name) {
  auto stream = std::make_unique<Stream>();
  stream->shown_ = folder_ / name;
  stream->file_.reset(std::fopen(reserve(name).c_str(), "wb"));
  if (!stream->file_) fail(stream->shown_, std::strerror(errno));
  streams_.push_back(std::move(stream));
  return *streams_.back();
}

void OutputFolder::add(const std::string& name, const std::string& content) {
  Stream& stream = open(name);
  stream.write(content);
  stream.finish();
}

std::vector<std::string> OutputFolder::names() const {
  std::vector<std::string> names;
  for (const Pending& file : pending_) names.push_back(file.final_path.filename());
  return names;
}

// Files of an earlier set, as its record names them.
std::vector<fs::path> OutputFolder::superseded(const std::string& record,
                                               const NamesIn& names_in) const {
  std::vector<fs::path> files;
  std::error_code error;
  const fs::path old_record = folder_ / record;
  const auto written = fs::last_write_time(old_record, error);
  if (record.empty() || !names_in || error) return files;
  std::string text;
  try {
    text = read_input_file(old_record, {"a report", kLargestReport});
  } catch (const InputError&) {
    return files;  // it is no record
  }
  for (const fs::path name : names_in(text)) {
    if (name.empty() || name != name.filename() || name == "." || name == "..") continue;
    const fs::path file = folder_ / name;
    const bool in_this_set =
        std::any_of(pending_.begin(), pending_.end(),
                    [&](const Pending& pending) { return pending.final_path == file; });
    if (in_this_set || !fs::is_regular_file(fs::symlink_status(file, error))) continue;
    // The record is written last: what is younger is somebody else's.
    const auto changed = fs::last_write_time(file, error);
    if (!error && changed <= written) files.push_back(file);
  }
  return files;
}

// Takes back what commit() has put in place so far.
void OutputFolder::put_back() noexcept {
  std::error_code ignored;
  for (const Pending& file : pending_) {
    const bool in_place = !fs::exists(file.temporary, ignored);
    if (fs::exists(fs::symlink_status(file.before, ignored)))
      fs::rename(file.before, file.final_path, ignored);
    else if (in_place)
      fs::remove(file.final_path, ignored);
    fs::remove(file.before, ignored);  // the same file under both names is not renamed
  }
}

std::vector<fs::path> OutputFolder::commit(const std::string& record, const NamesIn& names_in) {
  for (const auto& stream : streams_) stream->finish();
  const FolderLock lock(folder_);
  for (const Pending& file : pending_)
    if (fs::is_directory(file.final_path)) fail(file.final_path, "is a directory");
  const std::vector<fs::path> old = superseded(record, names_in);
  std::vector<fs::path> paths;
  const auto move = [&](const fs::path& from, const fs::path& to, const fs::path& shown) {
    std::error_code error;
    fs::rename(from, to, error);
    if (!error) return;
    put_back();
    fail(shown, error.message());
  };
  // All that is replaced gets a second name first, so that a failure in the middle can be taken
  // back; where the file system has no second names it steps aside.
  for (const Pending& file : pending_) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(file.final_path, error))) continue;
    fs::create_hard_link(file.final_path, file.before, error);
    if (error) move(file.final_path, file.before, file.final_path);
  }
  for (const Pending& file : pending_) {
    move(file.temporary, file.final_path, file.final_path);
    paths.push_back(file.final_path);
  }
  std::error_code ignored;
  for (const fs::path& file : old) fs::remove(file, ignored);
  pending_.clear();
  staging_.reset();
  StagingFolder::remove_abandoned(folder_, kStaging);
  created_.clear();
  return paths;
}

void write_file(const fs::path& file, const std::string& content) {
  const fs::path path = fs::absolute(file);
  OutputFolder folder(path.parent_path());
  folder.add(path.filename(), content);
  folder.commit();
}

}  // namespace bentaxis

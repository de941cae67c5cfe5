#include "unpacked.h"

#include <zip.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>
#include <system_error>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "process/remove_tree.h"

namespace bentaxis::fmu {
namespace {

namespace fs = std::filesystem;

constexpr zip_int64_t kMaxEntries = 20000;
constexpr std::size_t kPiece = 1U << 16;
// Of modelDescription.xml, in bytes.
constexpr std::uint64_t kLargestDescription = 64ULL << 20U;
constexpr std::string_view kDescription = "modelDescription.xml";

[[noreturn]] void fail(const fs::path& file, const std::string& why) {
  throw InputError(file.string() + ": " + why);
}

// Names that stay below the folder they are unpacked into.
bool stays_inside(const std::string& name) {
  if (name.empty() || name.front() == '/' || name.find('\\') != std::string::npos ||
      name.find(':') != std::string::npos)
    return false;
  const fs::path path(name);
  return std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
}

bool is_needed(const std::string& name) {
  if (name == kDescription || name.starts_with("resources/")) return true;
  return name.starts_with("binaries/" + platform_folder(2) + "/") ||
         name.starts_with("binaries/" + platform_folder(3) + "/");
}

struct Close {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

}  // namespace

std::string platform_folder(int version) {
#if defined(__aarch64__)
  return version == 2 ? "linux-aarch64" : "aarch64-linux";
#else
  return version == 2 ? "linux64" : "x86_64-linux";
#endif
}

Unpacked::Unpacked(const fs::path& archive, std::uint64_t most,
                   const std::function<void(const fs::path& folder)>& made)
    : file_(archive) {
  if (!fs::exists(archive)) fail(archive, "does not exist");
  if (fs::is_directory(archive)) fail(archive, "is a directory: must be a .fmu file");
  if (!fs::is_regular_file(archive))
    fail(archive, "is a pipe, a socket or a device: an FMU must be a regular file");
  if (fs::file_size(archive) > most)
    fail(archive, "is larger than " + std::to_string(most >> 20U) + " MiB");
  std::string pattern = (fs::absolute(fs::temp_directory_path()) / "bentaxis-fmu-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    fail(pattern, "the directory for the unpacked FMU cannot be made");
  folder_ = pattern;
  try {
    if (made) made(folder_);
    unpack(archive, most);
  } catch (...) {
    remove();
    throw;
  }
}

Unpacked::~Unpacked() { remove(); }

void Unpacked::remove() noexcept {
  if (!folder_.empty()) process::remove_tree(folder_);
}

void Unpacked::unpack(const fs::path& file, std::uint64_t most) {
  const std::string content = read_input_file(file, {"an FMU", most});
  InputLog::note(file, content);
  zip_source_t* const source = zip_source_buffer_create(content.data(), content.size(), 0, nullptr);
  const std::unique_ptr<zip_t, Close> archive(
      source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, nullptr));
  if (!archive) zip_source_free(source);
  if (!archive) fail(file, "is not a zip archive, or it is damaged: must be a .fmu file");
  const zip_int64_t entries = zip_get_num_entries(archive.get(), 0);
  if (entries > kMaxEntries)
    fail(file, "has " + std::to_string(entries) + " entries: at most " +
                   std::to_string(kMaxEntries) + " are unpacked");
  std::uint64_t bytes = 0;
  std::vector<char> piece(kPiece);
  for (zip_int64_t i = 0; i < entries; ++i) {
    const char* raw = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), 0);
    const std::string name = raw != nullptr ? raw : "";
    if (has_control_characters(name, true))
      fail(file, "entry \"" + without_control_characters(name) + "\": holds a control character");
    if (!stays_inside(name))
      fail(file, "entry \"" + name + "\" would be unpacked outside of its directory");
    if (constexpr std::string_view kBinaries = "binaries/"; name.starts_with(kBinaries)) {
      const std::string platform =
          name.substr(kBinaries.size(), name.find('/', kBinaries.size()) - kBinaries.size());
      if (!platform.empty()) add_once(platforms_, platform);
    }
    if (name.back() == '/' || !is_needed(name)) continue;
    const std::unique_ptr<zip_file_t, Close> in(
        zip_fopen_index(archive.get(), static_cast<zip_uint64_t>(i), 0));
    if (!in) fail(file, name + " cannot be unpacked: the archive is damaged or encrypted");
    const fs::path target = folder_ / name;
    std::error_code failed;
    fs::create_directories(target.parent_path(), failed);
    std::ofstream out(target, std::ios::binary);
    for (;;) {
      const zip_int64_t count = zip_fread(in.get(), piece.data(), piece.size());
      if (count < 0) fail(file, name + " cannot be unpacked: the archive is damaged");
      if (count == 0) break;
      bytes += static_cast<std::uint64_t>(count);
      if (bytes > most)
        fail(file, "is larger than " + std::to_string(most >> 20) + " MiB when unpacked");
      out.write(piece.data(), count);
    }
    out.close();
    if (failed || !out)
      fail(target, "cannot be written: is there disk space for the unpacked FMU?");
  }
  fs::create_directories(folder_ / "resources");
  if (!fs::is_regular_file(folder_ / kDescription))
    fail(file, "is not an FMU: it has no modelDescription.xml");
  if (fs::file_size(folder_ / kDescription) > kLargestDescription)
    fail(file, "modelDescription.xml is larger than " + std::to_string(kLargestDescription >> 20U) +
                   " MiB");
}

std::string Unpacked::description() const {
  std::ifstream in(folder_ / kDescription, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace bentaxis::fmu

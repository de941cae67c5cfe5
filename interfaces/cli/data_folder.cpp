#include "data_folder.h"

#include <fstream>

namespace bentaxis::cli {
namespace fs = std::filesystem;

std::optional<fs::path> shipped_folder(const std::string& name, const fs::path& file,
                                       const std::string& data_from_file) {
  std::error_code error;
  if (const fs::path folder = file.parent_path() / data_from_file / name;
      fs::is_directory(folder, error))
    return folder.lexically_normal();
  // In a build, not installed: that of the sources. The path is in a file, so that what is built
  // from the same sources in two places is equal.
  std::string sources;
  std::ifstream beside(file.parent_path() / BENTAXIS_SOURCES_FILE);
  if (std::getline(beside, sources))
    if (const fs::path folder = fs::path(sources) / name; fs::is_directory(folder, error))
      return folder.lexically_normal();
  return std::nullopt;
}

namespace {

std::optional<fs::path> shipped_with_program(const std::string& name) {
  std::error_code error;
  return shipped_folder(name, fs::read_symlink("/proc/self/exe", error), BENTAXIS_DATA_FROM_BINARY);
}

}  // namespace

std::string document(const std::string& name) {
  std::error_code error;
  const auto folder = shipped_folder("docs", fs::read_symlink("/proc/self/exe", error),
                                     BENTAXIS_DOCUMENTS_FROM_BINARY);
  return (folder.value_or("docs") / name).string();
}

std::optional<fs::path> shipped_reference_data() { return shipped_with_program("reference_data"); }

std::optional<fs::path> shipped_cases() { return shipped_with_program("cases"); }

std::optional<fs::path> shipped_problems() { return shipped_with_program("problems"); }

}  // namespace bentaxis::cli

#include "bentaxis/files/module_folders.h"

#include <dlfcn.h>

namespace bentaxis {
namespace {

// The file of the Python module, where this code is part of it; else that of the program, or what
// the program was called.
std::filesystem::path loaded_file() {
  static const int here = 0;
  Dl_info info{};
  if (dladdr(&here, &info) == 0 || info.dli_fname == nullptr) return {};
  return info.dli_fname;
}

}  // namespace

std::vector<std::filesystem::path> module_folders() {
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  const std::filesystem::path beside = program.parent_path();
  std::vector<std::filesystem::path> folders = {beside / BENTAXIS_MODULES_FROM_BINARY};
  // Of a build: from where its programs and its Python module are, so that no path of the machine
  // that built it is in what is installed.
  std::vector<std::filesystem::path> built = {beside / "../modules"};
  const std::filesystem::path file = loaded_file();
  if (file.is_absolute() && file.extension() == ".so") {
    folders.push_back(file.parent_path() / BENTAXIS_MODULES_FROM_PYTHON);
    built.push_back(file.parent_path() / "../../modules");
  }
  folders.emplace_back(BENTAXIS_MODULES_INSTALLED);
  folders.insert(folders.end(), built.begin(), built.end());
  return folders;
}

}  // namespace bentaxis

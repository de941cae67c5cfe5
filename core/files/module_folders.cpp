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
  std::vector<std::filesystem::path> folders = {program.parent_path() /
                                                BENTAXIS_MODULES_FROM_BINARY};
  const std::filesystem::path file = loaded_file();
  if (file.is_absolute() && file.extension() == ".so")
    folders.push_back(file.parent_path() / BENTAXIS_MODULES_FROM_PYTHON);
  folders.insert(folders.end(), {BENTAXIS_MODULES_INSTALLED, BENTAXIS_MODULES_BUILT});
  return folders;
}

}  // namespace bentaxis

#include "bentaxis/files/module_folders.h"

#include <dlfcn.h>
#include <link.h>

#include <cstddef>

namespace bentaxis {
namespace {

// Where a program, or a library, with the installed library in it finds the modules: a folder of
// its search path (target_link_options of bentaxis_files).
void add_installed(std::vector<std::filesystem::path>& folders) {
  static const int here = 0;
  Dl_info info{};
  link_map* object = nullptr;
  if (dladdr1(&here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) == 0) return;
  Dl_serinfo size{};
  if (dlinfo(object, RTLD_DI_SERINFOSIZE, &size) != 0) return;
  std::vector<std::max_align_t> room(size.dls_size / sizeof(std::max_align_t) + 1);
  auto* const paths = reinterpret_cast<Dl_serinfo*>(room.data());
  dlinfo(object, RTLD_DI_SERINFOSIZE, paths);
  if (dlinfo(object, RTLD_DI_SERINFO, paths) != 0) return;
  for (unsigned i = 0; i < paths->dls_cnt; ++i) {
    const std::filesystem::path folder = paths->dls_serpath[i].dls_name;
    if (folder.filename() == "bentaxis") folders.push_back(folder);
  }
}

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
  add_installed(folders);
  folders.emplace_back(BENTAXIS_MODULES_INSTALLED);
  folders.insert(folders.end(), built.begin(), built.end());
  return folders;
}

}  // namespace bentaxis

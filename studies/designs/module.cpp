#include "module.h"

#include <dlfcn.h>

#include <filesystem>

namespace bentaxis::designs {

Module::Module(const std::string& file) {
  if (file.empty()) return;
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  // Beside the program, where that is installed; where the library was installed or built.
  for (const std::filesystem::path& folder : {program.parent_path() / BENTAXIS_MODULES_FROM_BINARY,
                                              std::filesystem::path(BENTAXIS_MODULES_INSTALLED),
                                              std::filesystem::path(BENTAXIS_MODULES_BUILT)})
    if (library_ == nullptr && std::filesystem::exists(folder / file)) {
      library_ = dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL);
      if (library_ == nullptr) why_ = dlerror();
    }
}

void* Module::symbol(const char* name) const {
  return library_ == nullptr ? nullptr : dlsym(library_, name);
}

}  // namespace bentaxis::designs

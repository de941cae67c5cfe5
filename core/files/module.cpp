#include "module.h"

#include <dlfcn.h>

#include "bentaxis/files/module_folders.h"

namespace bentaxis::designs {

Module::Module(const std::string& file) {
  if (file.empty()) return;
  for (const std::filesystem::path& folder : module_folders())
    if (library_ == nullptr && std::filesystem::exists(folder / file)) {
      library_ = dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL);
      if (library_ == nullptr) why_ = dlerror();
    }
}

void* Module::symbol(const char* name) const {
  return library_ == nullptr ? nullptr : dlsym(library_, name);
}

}  // namespace bentaxis::designs

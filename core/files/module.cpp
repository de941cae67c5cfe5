#include "bentaxis/files/module.h"

#include <dlfcn.h>

#include "bentaxis/files/module_folders.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"

namespace bentaxis {

Module::Module(const std::string& file) : file_(file) {
  if (file.empty()) return;
  for (const std::filesystem::path& folder : module_folders())
    if (library_ == nullptr && std::filesystem::exists(folder / file)) {
      library_ = dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL);
      if (library_ == nullptr) why_ = dlerror();
    }
}

void* Module::needed(const char* name, const std::string& what) const {
  void* const found = library_ == nullptr ? nullptr : dlsym(library_, name);
  if (found == nullptr) throw InputError(what + ": " + what_is_wrong());
  return found;
}

std::string Module::what_is_wrong() const {
  const std::string folders = joined(module_folders(), ", ", [](const auto& folder) {
    return folder.lexically_normal().string();
  });
  return "the module " + file_ +
         (loaded()       ? " is of another version"
          : why_.empty() ? " is in none of the folders " + folders
                         : " cannot be loaded: " + why_) +
         "; build or install all of bentaxis again";
}

}  // namespace bentaxis

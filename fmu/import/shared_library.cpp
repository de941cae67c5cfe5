#include "shared_library.h"

#include <dlfcn.h>

#include "bentaxis/pump/error.h"

namespace bentaxis::fmu {

SharedLibrary::SharedLibrary(const std::filesystem::path& library, std::string unit)
    : unit_(std::move(unit)) {
  handle_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle_ != nullptr) return;
  const char* why = dlerror();
  throw InputError(unit_ + ": " + library.filename().string() +
                   " cannot be loaded: " + (why != nullptr ? why : "no reason given"));
}

SharedLibrary::~SharedLibrary() { dlclose(handle_); }

void* SharedLibrary::symbol(const char* name) const { return dlsym(handle_, name); }

void* SharedLibrary::needed(const char* name) const {
  void* function = symbol(name);
  if (function == nullptr)
    throw InputError(unit_ + ": its library has no function " + name +
                     ", which the standard asks for");
  return function;
}

}  // namespace bentaxis::fmu

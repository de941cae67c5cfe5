#include "bentaxis/multibody/versions.h"

#include <SimTKsimbody.h>
#include <dlfcn.h>

#include <filesystem>

namespace bentaxis::multibody {

std::string simbody_version() {
  int major = 0;
  int minor = 0;
  int build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(build);
}

std::string blas_library() {
  Dl_info info;
  if (dladdr(reinterpret_cast<void*>(&dgemm_), &info) == 0 || info.dli_fname == nullptr)
    return "unknown";
  std::error_code error;
  const auto path = std::filesystem::canonical(info.dli_fname, error);
  return error ? info.dli_fname : path.string();
}

}  // namespace bentaxis::multibody

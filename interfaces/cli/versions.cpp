#include "versions.h"

#include <sys/utsname.h>

#include <Eigen/Core>
#include <fstream>

#include "bentaxis/hydraulics/versions.h"
#include "bentaxis/multibody/versions.h"

namespace bentaxis::cli {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  utsname name{};
  return uname(&name) == 0 ? name.machine : "unknown";
}

}  // namespace

Lines shared_versions(const Lines& further) {
  Lines all = {
      {"bentaxis", BENTAXIS_VERSION},
      {"compiler",
#ifdef __clang__
       "Clang " __clang_version__
#else
       "GCC " __VERSION__
#endif
      },
      {"build", std::string(BENTAXIS_BUILD_TYPE) + ", " + BENTAXIS_CXX_FLAGS},
      {"Eigen", std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
                    "." + std::to_string(EIGEN_MINOR_VERSION)},
      {"Simbody", multibody::simbody_version()},
      {"BLAS", multibody::blas_library()}};
  all.insert(all.end(), further.begin(), further.end());
  all.emplace_back("processor", processor());
  return all;
}

}  // namespace bentaxis::cli

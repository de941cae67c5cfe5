#include <algorithm>
#include <string>

#include "bentaxis/designs/versions.h"
#include "bentaxis/engines/run.h"
#include "bentaxis/pump/lists.h"
#include "ranks.h"
#include "versions.h"

namespace bentaxis::cli {

Lines versions() {
  Lines libraries = designs::library_versions();
  const auto next = std::find_if(libraries.begin(), libraries.end(),
                                 [](const auto& one) { return one.first == "OpenTURNS"; });
  libraries.insert(next, {"MPI", mpi_library()});
  return shared_versions(libraries);
}

std::string optional_parts() {
  const Lines libraries = designs::library_versions();
  const auto version = [&](const std::string& name) {
    const auto found = std::find_if(libraries.begin(), libraries.end(),
                                    [&](const auto& one) { return one.first == name; });
    return found->second;
  };
  const std::string ceres = version("Ceres");
  const std::string engines = joined(engines::installed_engines(), " and ");
  return (ceres == "none" ? "Ceres none" : ceres) + ", HDF5 " + version("HDF5") + ", MPI " +
         mpi_library() + ", OpenTURNS " + version("OpenTURNS") + ", search " + version("search") +
         ", engines " + (engines.empty() ? "none" : engines) + ", Python module " BENTAXIS_PYTHON;
}

}  // namespace bentaxis::cli

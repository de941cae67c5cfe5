#include <algorithm>
#include <string>

#include "bentaxis/designs/least_squares.h"
#include "bentaxis/designs/propagation.h"
#include "bentaxis/designs/search.h"
#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/engines/run.h"
#include "ranks.h"
#include "versions.h"

namespace bentaxis::cli {

std::vector<std::pair<std::string, std::string>> versions() {
  auto all = shared_versions();
  const auto next = std::find_if(all.begin(), all.end(),
                                 [](const auto& one) { return one.first == "OpenTURNS"; });
  all.insert(next, {"MPI", mpi_library()});
  return all;
}

std::string optional_parts() {
  const std::string ceres = designs::least_squares_library();
  const std::string search = designs::search_libraries();
  std::string engines;
  for (const std::string& name : engines::installed_engines())
    engines += (engines.empty() ? "" : " and ") + name;
  return (ceres.empty() ? "Ceres none" : ceres) + ", HDF5 " + designs::hdf5_version() + ", MPI " +
         mpi_library() + ", OpenTURNS " + designs::openturns_version() + ", search " +
         (search.empty() ? "none" : search) + ", engines " + (engines.empty() ? "none" : engines) +
         ", Python module " BENTAXIS_PYTHON;
}

}  // namespace bentaxis::cli

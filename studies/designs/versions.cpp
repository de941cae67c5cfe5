#include "bentaxis/designs/versions.h"

#include "bentaxis/designs/least_squares.h"
#include "bentaxis/designs/propagation.h"
#include "bentaxis/designs/search.h"
#include "bentaxis/designs/sweep_tables.h"

namespace bentaxis::designs {

Lines library_versions() {
  const auto or_none = [](const std::string& version) {
    return version.empty() ? "none" : version;
  };
  return {{"HDF5", hdf5_version()},
          {"OpenTURNS", openturns_version()},
          {"Ceres", or_none(least_squares_library())},
          {"search", or_none(search_libraries())}};
}

}  // namespace bentaxis::designs

// The optional libraries of studies.
#pragma once

#include "bentaxis/results/remarks.h"

namespace bentaxis::designs {

/// Name and version of HDF5, OpenTURNS, Ceres and what searches; "none" where this build lacks it.
Lines library_versions();

}  // namespace bentaxis::designs

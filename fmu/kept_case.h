// A case as an archive keeps it. Internal.
#pragma once

#include <string>
#include <vector>

#include "archive.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::fmu {

struct KeptCase {
  std::string text;                 ///< of a case file that names its curves relative to itself
  std::vector<ArchiveFile> curves;  ///< by these names: "curves/motor.csv"
};

/// @throws InputError where a curve cannot be read
KeptCase kept_case(const Case& the_case);

}  // namespace bentaxis::fmu

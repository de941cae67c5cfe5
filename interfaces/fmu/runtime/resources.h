// What lies in the resources of a unit. Internal.
#pragma once

#include <filesystem>
#include <string>

#include "bentaxis/pump/case.h"
#include "variables.h"

namespace bentaxis::fmu {

struct Resources {
  Case the_case;      ///< with its [drive] as the unit has it
  UnitChoice choice;  ///< unit.txt
  std::string token;  ///< likewise: guid of FMI 2, instantiationToken of FMI 3
};

/// A path as FMI writes it: in UTF-8, on Windows too.
std::filesystem::path path_of_text(const std::string& text);

/// A file URI (file:///folder, file:/folder, file://localhost/folder) with percent encoding, as FMI
/// 2 gives the folder of resources; a path without a scheme is one too. On Windows
/// file:///C:/folder is the folder C:/folder.
/// @throws InputError
std::filesystem::path path_of_uri(const std::string& uri);

/// @throws InputError
Resources read_resources(const std::filesystem::path& folder);

}  // namespace bentaxis::fmu

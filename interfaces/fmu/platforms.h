// The platforms that an FMU can be for. Internal.
#pragma once

#include <string>
#include <vector>

#include "archive.h"
#include "bentaxis/fmu/unit.h"

namespace bentaxis::fmu {

/// What is in the archive for one platform.
struct PlatformLibrary {
  std::string place;     ///< of the library in the archive
  std::string bytes;     ///< of the library
  std::string licences;  ///< of what is joined to it on this platform only; may be empty
  std::string needs;     ///< in words: "Linux on x86-64 with glibc 2.35 or newer"
};

/// @throws InputError where a platform is given more than once, is not installed, or is none of the
/// version's
std::vector<PlatformLibrary> platform_libraries(Version version,
                                                const std::vector<Platform>& platforms);

/// What the library is compiled from: the folder `sources` of the archive, in the order of names.
/// @throws InputError where it is not installed or the version knows no such sources
std::vector<ArchiveFile> source_files(Version version);

/// "A and B": what the FMU runs on.
std::string needs_of(const std::vector<PlatformLibrary>& libraries);

}  // namespace bentaxis::fmu

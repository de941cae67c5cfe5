// Zip archives in memory. Internal.
#pragma once

#include <string>
#include <vector>

namespace bentaxis::fmu {

struct ArchiveFile {
  std::string name;  ///< in the archive, '/' between folders
  std::string bytes;
  bool program = false;  ///< may be run
};

/// The bytes of a zip archive of these files, in their order. The same files give the same bytes:
/// all have the date 1980-01-01 00:00 and no trace of this machine.
/// @throws ComputationError where there is no memory for it
std::string zip_archive(const std::vector<ArchiveFile>& files);

}  // namespace bentaxis::fmu

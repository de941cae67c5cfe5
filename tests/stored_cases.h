// Cases that are stored with the program.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "support.h"

namespace bentaxis::test {

/// All that have a turn at constant speed: without those of pistons that turn the block, whose oil
/// follows the motion.
inline std::vector<std::filesystem::path> cases_with_a_turn() {
  std::vector<std::filesystem::path> files;
  for (const auto& name : reference_cases())
    files.push_back(reference_folder() / name / "case.toml");
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases")) {
    if (entry.path().extension() != ".toml") continue;
    const Case the_case = read_case(entry.path());
    if (the_case.pressure.kind == PressureKind::hydraulic &&
        the_case.pump.transfer.kind == TransferKind::pistons)
      continue;
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace bentaxis::test

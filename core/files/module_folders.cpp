#include "bentaxis/files/module_folders.h"

namespace bentaxis {

std::vector<std::filesystem::path> module_folders() {
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  return {program.parent_path() / BENTAXIS_MODULES_FROM_BINARY, BENTAXIS_MODULES_INSTALLED,
          BENTAXIS_MODULES_BUILT};
}

}  // namespace bentaxis

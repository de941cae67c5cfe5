#include "data_folder.h"

namespace bentaxis::cli {
namespace fs = std::filesystem;

std::optional<fs::path> shipped_reference_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& folder :
       {program.parent_path() / BENTAXIS_DATA_FROM_BINARY / "reference_data",
        fs::path(BENTAXIS_SOURCE_DIR) / "reference_data"})
    if (fs::is_directory(folder, error)) return folder.lexically_normal();
  return std::nullopt;
}

}  // namespace bentaxis::cli

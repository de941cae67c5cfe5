#include "data_folder.h"

#include "bentaxis/pump/error.h"

namespace bentaxis::cli {
namespace fs = std::filesystem;

fs::path reference_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed =
      program.parent_path().parent_path() / BENTAXIS_DATA_DIR "/bentaxis/reference_data";
  const fs::path in_tree = BENTAXIS_SOURCE_DIR "/reference_data";
  for (const fs::path& folder : {installed, in_tree})
    if (fs::is_directory(folder, error)) return fs::weakly_canonical(folder);
  throw InputError(installed.string() + ": no such folder, nor " + in_tree.string());
}

}  // namespace bentaxis::cli

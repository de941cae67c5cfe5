// A sweep's results as HDF5, written block by block.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "bentaxis/designs/sweep_parts.h"

namespace bentaxis::designs {

class Hdf5File {
 public:
  /// @throws InputError where the file cannot be written, or the program was built without HDF5
  Hdf5File(const std::filesystem::path& file, const Sweep& sweep, const SweepRecord& record);
  ~Hdf5File();
  void add(const SweepBlock& block);
  /// Writes the checks and closes the file.
  void finish(const std::vector<SweepCheck>& checks);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace bentaxis::designs

// A sweep's results as files: CSV and HDF5 (docs/sweeps.md).
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/sweep_parts.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::designs {

struct SweepFormats {
  bool csv = true;
  bool hdf5 = false;
};
/// Whether this program can write HDF5.
bool has_hdf5();
std::string why_no_hdf5();   ///< "" where it can
std::string hdf5_version();  ///< "none" where the program was built without it

/// Writes sweep.csv, sweep.h5 and, where designs were checked, sweep_checks.csv, block by block:
/// memory does not grow with the number of designs.
/// @return the results, of more than `most` designs only some: every second, third, ..
/// @throws InputError where blocks are missing or damaged, naming them
SweepResult write_sweep(const Sweep& sweep, const SweepParts& parts, const SweepFormats& formats,
                        OutputFolder& folder, int threads, const Progress& progress,
                        std::size_t most = 200000);

/// sweep.csv of results that are in memory, all of them.
std::string sweep_csv(const SweepResult& result);

/// Designs and outputs at which the other model disagrees, a line each; of many the first ones.
std::string disagreements_text(const SweepResult& result);

}  // namespace bentaxis::designs

// What the commands sweep and merge share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/designs/sweep_tables.h"
#include "command_parser.h"
#include "report_files.h"

namespace bentaxis::cli {

/// --output, --minimise, --maximise.
void add_outputs(CommandParser command, designs::SweepRequest& request);
/// --format.
void add_formats(CommandParser command, std::vector<std::string>& formats);
/// Of none: all that this program can write. @throws InputError
designs::SweepFormats formats_of(const std::vector<std::string>& formats);

/// Where finished blocks of a sweep to this folder wait.
std::filesystem::path parts_in(const std::filesystem::path& out);

/// Computes the blocks of a share; where that ends early, says which are kept.
/// @return how many were there already
std::size_t compute_or_say(const designs::Sweep& sweep, const designs::SweepParts& parts,
                           const designs::SweepShare& share);

/// Writes the results of all blocks and prints what came out. @return the exit status
int write_results(const designs::Sweep& sweep, const designs::SweepParts& parts,
                  const designs::SweepFormats& formats, int threads, ReportFolders& folders);

}  // namespace bentaxis::cli

// What the commands sweep and merge share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/sweep_tables.h"
#include "command_parser.h"
#include "report_files.h"

namespace bentaxis::cli {

/// What is to be computed, as the line says it.
struct PlanOptions {
  std::string study, check;
  std::vector<std::string> vary;
  designs::SweepRequest request;
  int samples = 0, seed = 1;
};
/// --vary, --output, --minimise, --maximise, --study, --sampling, --samples, --seed, --model,
/// --check.
void add_plan(CommandParser command, PlanOptions& options);
/// NAME=VALUES apart. @throws InputError
std::vector<std::pair<std::string, std::string>> varied_of(const std::vector<std::string>& texts);
/// What the study file says, and the options that were given. @throws InputError
designs::SweepRequest request_of(const PlanOptions& options, const CommandParser& command);

/// --format.
void add_formats(CommandParser command, std::vector<std::string>& formats);
/// Of none: all that this program can write. @throws InputError
designs::SweepFormats formats_of(const std::vector<std::string>& formats);

/// Where finished blocks of a sweep to this folder wait.
std::filesystem::path parts_in(const std::filesystem::path& out);

/// Says on standard error which blocks are kept after a sweep has ended early, and how to go on.
/// @param why  begins the line: "interrupted; " or ""
/// @return their number; of none nothing is said
std::size_t say_kept(const designs::Sweep& sweep, const designs::SweepParts& parts,
                     const std::string& why);

/// Computes the blocks of a share; where that ends early, says how many are kept.
/// @return what was there already; nothing where the user has interrupted it
std::optional<designs::ResumedBlocks> compute_or_say(const designs::Sweep& sweep,
                                                     const designs::SweepParts& parts,
                                                     const designs::SweepShare& share);

/// Writes the results of all blocks and prints what came out. @return the exit status
int write_results(const designs::Sweep& sweep, const designs::SweepParts& parts,
                  const designs::SweepFormats& formats, int threads, ReportFolders& folders);

}  // namespace bentaxis::cli

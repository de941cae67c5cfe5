// What the commands sweep and merge share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/sweep_tables.h"
#include "command_parser.h"
#include "options.h"
#include "ranks.h"
#include "report_files.h"

namespace bentaxis::cli {

/// What is to be computed, as the line says it.
struct PlanOptions {
  std::string study, check;
  std::vector<std::string> vary;
  designs::SweepRequest request;
};
/// --vary, --output, --minimise, --maximise, --study, --sampling, --samples, --seed, --model,
/// --check.
void add_plan(CommandParser command, PlanOptions& options);
/// Parameters of a study file with their values, and what --vary says in place of them and besides.
/// @param texts  NAME=VALUES each. @throws InputError
using Varied = std::vector<std::pair<std::string, std::string>>;
void vary_anew(Varied& varied, const std::vector<std::string>& texts);
/// What the study file says, and the options that were given. @throws InputError
designs::SweepRequest request_of(const PlanOptions& options, const CommandParser& command);

/// --format.
void add_formats(CommandParser command, std::vector<std::string>& formats);
/// Of none: all that this program can write. @throws InputError
designs::SweepFormats formats_of(const std::vector<std::string>& formats);

/// The case in every rank; the first says what of it is doubtful.
Case base_of(const CaseOption& the_case, const Ranks& ranks);
/// Threads of a rank, of those asked for; 0: one where there are several ranks.
int threads_of(const Ranks& ranks, int threads);

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

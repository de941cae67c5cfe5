#include <algorithm>
#include <filesystem>

#include "command_tools.h"
#include "sweep_options.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  ReportPlace place;
  std::vector<std::string> folders, formats;
};

// The folder of blocks that was named, or stands in the folder that was named.
fs::path blocks_in(const fs::path& named) {
  return fs::is_directory(parts_in(named)) ? parts_in(named) : named;
}

int merge(const MergeOptions& options) {
  const designs::SweepFormats formats = formats_of(options.formats);
  std::vector<fs::path> sources(options.folders.begin(), options.folders.end());
  std::transform(sources.begin(), sources.end(), sources.begin(), blocks_in);
  const fs::path own = parts_in(options.place.out);
  if (fs::is_directory(own)) sources.insert(sources.begin(), own);
  if (sources.empty())
    throw InputError(own.string() + ": no such directory; give one with blocks of a sweep");
  const auto [sweep, record] = designs::sweep_in(sources.front());
  designs::SweepParts parts(sources.front(), record);
  for (auto more = sources.begin() + 1; more != sources.end(); ++more) parts.add(*more);
  const RunLock lock = parts.reading();
  ReportFolders folders(options.place);
  try {
    return write_results(sweep, parts, formats, 0, folders);
  } catch (const Interrupted&) {
    std::fprintf(stderr,
                 "bentaxis: interrupted; no results were written; the blocks stay where they are: "
                 "merge them again\n");
    return kInterrupted;
  }
}

}  // namespace

Command add_merge_command(CommandParser program) {
  auto options = std::make_shared<MergeOptions>();
  auto command =
      program.subcommand("merge", "Results of a sweep that was computed in parts (sweep --part)");
  command.option("OUT", options->place.out, Values().required(),
                 "folder of the parts and of the results");
  command.option("FOLDER", options->folders, "further folders with parts, from elsewhere");
  add_figures(command, options->place.figures);
  add_formats(command, options->formats);
  return {command, [options] { return merge(*options); }};
}

}  // namespace bentaxis::cli

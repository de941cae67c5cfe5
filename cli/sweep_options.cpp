#include "sweep_options.h"

#include <cstdio>

#include "bentaxis/designs/sweep_document.h"
#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"
#include "versions.h"

namespace bentaxis::cli {

void add_outputs(CommandParser command, designs::SweepRequest& request) {
  const std::string names = "NAME[,NAME..]";
  command.option("--output", request.outputs, "numbers asked for, as max:Rb1_z1 (docs/sweeps.md)")
      .list()
      .text(names);
  command.option("--minimise", request.minimise, "outputs of which less is better")
      .list()
      .text(names);
  command.option("--maximise", request.maximise, "outputs of which more is better")
      .list()
      .text(names);
}

void add_formats(CommandParser command, std::vector<std::string>& formats) {
  command.option("--format", formats, "files of results")
      .list()
      .one_of({"csv", "hdf5"})
      .text("csv,hdf5");
}

designs::SweepFormats formats_of(const std::vector<std::string>& formats) {
  designs::SweepFormats result{.csv = formats.empty(),
                               .hdf5 = formats.empty() && designs::has_hdf5()};
  for (const std::string& format : formats) (format == "csv" ? result.csv : result.hdf5) = true;
  if (result.hdf5 && !designs::has_hdf5())
    throw InputError(
        "--format hdf5: this program was built without HDF5; install libhdf5-dev (scripts/setup "
        "full) and build again");
  return result;
}

std::filesystem::path parts_in(const std::filesystem::path& out) { return out / "sweep.parts"; }

std::size_t compute_or_say(const designs::Sweep& sweep, const designs::SweepParts& parts,
                           const designs::SweepShare& share) {
  try {
    return designs::compute_blocks(sweep, parts, share, progress_of("sweep"));
  } catch (...) {
    const std::size_t kept = parts.count();
    if (kept == 0 && share.ranks == 1 && share.parts == 1) parts.remove(0);
    if (kept > 0 && share.rank == 0)
      std::fprintf(stderr, "bentaxis: %zu of %zu blocks are in %s: --resume goes on from them\n",
                   kept, sweep.blocks(), parts.folder().c_str());
    throw;
  }
}

int write_results(const designs::Sweep& sweep, const designs::SweepParts& parts,
                  const designs::SweepFormats& formats, int threads, ReportFolders& folders) {
  const designs::SweepResult result = designs::write_sweep(sweep, parts, formats, folders.tables(),
                                                           threads, progress_of("writing"));
  const auto paths = folders.write("report", designs::sweep_document(result, versions()), {}, {});
  std::printf("%s\n%s", designs::headline(result).c_str(),
              designs::disagreements_text(result).c_str());
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return result.agrees() ? kDone : kOutOfTolerance;
}

}  // namespace bentaxis::cli

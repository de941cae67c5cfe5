#include <algorithm>
#include <charconv>
#include <filesystem>

#include "bentaxis/designs/sweep_tables.h"
#include "command_tools.h"
#include "ranks.h"
#include "sweep_options.h"

namespace bentaxis::cli {
namespace {

struct SweepOptions {
  CaseOption the_case;
  ReportPlace place;
  PlanOptions plan;
  std::string part;
  std::vector<std::string> formats;
  designs::SweepShare share;
};

// Which blocks a rank of a part computes.
designs::SweepShare share_of(const SweepOptions& options, const Ranks& ranks) {
  designs::SweepShare share = options.share;
  share.rank = static_cast<std::size_t>(ranks.rank());
  share.ranks = static_cast<std::size_t>(ranks.size());
  share.threads = threads_of(ranks, share.threads);
  if (options.part.empty()) return share;
  const char* const end = options.part.data() + options.part.size();
  const auto [slash, error] = std::from_chars(options.part.data(), end, share.part);
  bool good = error == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [stop, worse] = std::from_chars(slash + 1, end, share.parts);
    good = worse == std::errc() && stop == end && share.part >= 1 && share.part <= share.parts;
  }
  if (!good) throw InputError("--part " + options.part + ": must be I/N with 1 <= I <= N");
  --share.part;
  return share;
}

int sweep(const SweepOptions& options, const CommandParser& command, const Ranks& ranks) {
  const bool first = ranks.rank() == 0;
  const designs::SweepRequest request = request_of(options.plan, command);
  const designs::SweepShare share = share_of(options, ranks);
  const designs::SweepFormats formats = formats_of(options.formats);
  const Case base = base_of(options.the_case, ranks);
  const designs::Sweep sweep(base, designs::sweep_plan(request, base));
  const designs::SweepParts parts(parts_in(options.place.out),
                                  designs::record_of(sweep, "bentaxis " BENTAXIS_VERSION));
  ranks.must_be_same(parts.record().identity, "case, plan or version");
  std::optional<ReportFolders> folders;
  std::optional<RunLock> lock;
  if (first) {
    folders.emplace(options.place);
    lock.emplace(parts.begin(share.parts > 1 ? RunLock::Kind::shared : RunLock::Kind::alone));
  }
  ranks.wait();
  const auto before = compute_or_say(sweep, parts, share);
  if (!before) return kInterrupted;
  ranks.wait();
  if (!first) return kDone;
  if (!before->misplaced.empty())
    std::fprintf(stderr,
                 "bentaxis: %s: files of these blocks held the designs of another block, and the "
                 "blocks were computed again: %s\n",
                 parts.folder().c_str(), designs::list_of(before->misplaced).c_str());
  if (share.resume) std::fprintf(stderr, "bentaxis: %zu blocks were there already\n", before->kept);
  if (share.parts > 1) {
    std::printf("part %s is in %s; bentaxis merge %s makes results of all parts\n",
                options.part.c_str(), parts.folder().c_str(), options.place.out.c_str());
    return kDone;
  }
  try {
    const int status = write_results(sweep, parts, formats, share.threads, *folders);
    parts.remove(sweep.blocks());
    return status;
  } catch (const Interrupted&) {
    say_kept(sweep, parts, "interrupted; ");
    return kInterrupted;
  } catch (...) {
    say_kept(sweep, parts, "");
    throw;
  }
}

}  // namespace

Command add_sweep_command(CommandParser program) {
  auto options = std::make_shared<SweepOptions>();
  auto command = program.subcommand(
      "sweep",
      "Outputs of many designs: grids and samples of any parameters, on any number of cores");
  add_case(command, options->the_case);
  add_report(command, options->place, "report.html, report.json, sweep.csv and sweep.h5");
  add_plan(command, options->plan);
  add_formats(command, options->formats);
  command.option("--part", options->part, "I/N",
                 "compute this part of the blocks only; then merge");
  command.flag("--resume", options->share.resume,
               "continue an interrupted run; with the blocks that it has left in the directory");
  add_threads(command, options->share.threads, "0: one per processor, one where started by mpirun");
  return {command, [options, command] {
            return in_ranks([&](const Ranks& ranks) { return sweep(*options, command, ranks); });
          }};
}

}  // namespace bentaxis::cli

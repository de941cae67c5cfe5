#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "commands.h"
#include "console.h"
#include "options.h"
#include "ranks.h"
#include "report_files.h"
#include "sweep_options.h"

namespace bentaxis::cli {
namespace {

struct Options {
  CaseOption the_case;
  ReportPlace place;
  std::string study, part, check;
  std::vector<std::string> vary, formats;
  designs::SweepRequest request;
  int samples = 0, seed = 1;
  designs::SweepShare share;
};

double check_share(const std::string& text) {
  const bool percent = text.ends_with('%');
  const char* const end = text.data() + text.size() - (percent ? 1 : 0);
  double share = -1;
  const auto [stop, error] = std::from_chars(text.data(), end, share);
  if (percent) share /= 100;
  if (error != std::errc() || stop != end || !(share >= 0 && share <= 1))
    throw InputError("--check " + text + ": must be a share of the designs, 0% to 100%");
  return share;
}

// What the study file says, and the options that were given.
designs::SweepRequest request_of(const Options& options, const CommandParser& command) {
  designs::SweepRequest request;
  if (!options.study.empty()) request = designs::read_sweep_request(options.study);
  const designs::SweepRequest& given = options.request;
  for (const std::string& text : options.vary) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw InputError("--vary " + text + ": must be NAME=VALUES, as in pump.tilt_deg=20:40:5");
    const std::string name = text.substr(0, equals);
    std::erase_if(request.vary, [&](const auto& old) { return old.first == name; });
    request.vary.emplace_back(name, text.substr(equals + 1));
  }
  const auto append = [](std::vector<std::string>& to, const std::vector<std::string>& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  append(request.outputs, given.outputs);
  append(request.minimise, given.minimise);
  append(request.maximise, given.maximise);
  if (command.given("--sampling")) request.sampling = given.sampling;
  if (command.given("--samples")) request.samples = static_cast<std::size_t>(options.samples);
  if (command.given("--seed")) request.seed = static_cast<std::uint64_t>(options.seed);
  if (command.given("--model")) request.model = given.model;
  if (!options.check.empty()) request.check_share = check_share(options.check);
  return request;
}

// Which blocks a rank of a part computes.
designs::SweepShare share_of(const Options& options, const Ranks& ranks) {
  designs::SweepShare share = options.share;
  share.rank = static_cast<std::size_t>(ranks.rank());
  share.ranks = static_cast<std::size_t>(ranks.size());
  if (ranks.size() > 1 && share.threads == 0) share.threads = 1;
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

int sweep(const Options& options, const CommandParser& command, const Ranks& ranks) {
  const bool first = ranks.rank() == 0;
  const designs::SweepRequest request = request_of(options, command);
  const designs::SweepShare share = share_of(options, ranks);
  const designs::SweepFormats formats = formats_of(options.formats);
  const Case base =
      first ? options.the_case.read() : read_case(options.the_case.file, options.the_case.changes);
  const designs::Sweep sweep(base, designs::sweep_plan(request, base));
  const designs::SweepParts parts(parts_in(options.place.out),
                                  designs::record_of(sweep, "bentaxis " BENTAXIS_VERSION));
  ranks.must_be_same(parts.record().identity, "case, plan or version");
  std::optional<ReportFolders> folders;
  if (first) {
    folders.emplace(options.place);
    parts.begin();
  }
  ranks.wait();
  const std::size_t before = compute_or_say(sweep, parts, share);
  ranks.wait();
  if (!first) return kDone;
  if (share.resume) std::fprintf(stderr, "bentaxis: %zu blocks were there already\n", before);
  if (share.parts > 1) {
    std::printf("part %s is in %s; bentaxis merge %s makes results of all parts\n",
                options.part.c_str(), parts.folder().c_str(), options.place.out.c_str());
    return kDone;
  }
  const int status = write_results(sweep, parts, formats, share.threads, *folders);
  parts.remove(sweep.blocks());
  return status;
}

}  // namespace

Command add_sweep_command(CommandParser program) {
  auto options = std::make_shared<Options>();
  CommandParser command = program.subcommand(
      "sweep",
      "Outputs of many designs: grids and samples of any parameters, on any number of cores");
  add_case(command, options->the_case);
  add_report(command, options->place, "report.html, report.json, sweep.csv and sweep.h5");
  command.option("--vary", options->vary, "a parameter and its values (docs/sweeps.md)")
      .repeatable()
      .text("NAME=VALUES");
  add_outputs(command, options->request);
  command.option("--study", options->study, "the same in a file; options come on top").text("FILE");
  command.choice("--sampling", options->request.sampling, designs::sampling_words(),
                 "every combination, or points in distributions");
  command.option("--samples", options->samples, "number of points; not of a grid")
      .integer_in(1, 1000000000)
      .text("NUMBER");
  command.option("--seed", options->seed, "of the points; 0: Sobol's sequence as it is")
      .integer_in(0, 2147483647)
      .text("NUMBER [1]");
  command.choice("--model", options->request.model, {"analytic", "multibody"}, "which model");
  command
      .option("--check", options->check, "share of the designs that the other model computes too")
      .text("SHARE [0%]");
  add_formats(command, options->formats);
  command.option("--part", options->part, "compute this part of the blocks only; then merge")
      .text("I/N");
  command.flag("--resume", options->share.resume,
               "keep the blocks that an interrupted run has left in the folder");
  command
      .option("--threads", options->share.threads,
              "0: one per processor, one where started by mpirun")
      .integer_in(0, 1024)
      .text("NUMBER [0]");
  return {command, [options, command] {
            return in_ranks([&](const Ranks& ranks) { return sweep(*options, command, ranks); });
          }};
}

}  // namespace bentaxis::cli

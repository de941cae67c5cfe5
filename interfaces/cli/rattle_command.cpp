#include <filesystem>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/run_lock.h"
#include "bentaxis/study/rattle_document.h"
#include "bentaxis/study/rattle_file.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

struct RattleCommandOptions {
  CaseOption the_case;
  ReportPlace place;
  std::string speeds, delivery;
  bool resume = false;
  study::RattleOptions rattle;
};

// What rows of this map are computed from.
std::string origin_of(const Case& the_case, const study::RattleOptions& options) {
  std::string text = case_text(the_case);
  for (const InputFile& input : InputLog::files())
    if (input.file != the_case.file) text += input.sha256;
  return std::string("bentaxis ") + BENTAXIS_VERSION + ", case " + sha256_of(text).substr(0, 16) +
         ", " + study::options_text(options);
}

int rattle(const RattleCommandOptions& options) {
  study::RattleOptions rattle = options.rattle;
  constexpr double kMinSpeed = 1;  // rpm
  rattle.speed_rpm = values_in("--speeds", options.speeds, "rpm", kMinSpeed);
  rattle.delivery_bar = values_in("--delivery-bar", options.delivery, "bar", 0);
  const Case the_case = options.the_case.read();
  if (rattle.check > 0 && !the_case.pump.block_moves_freely())
    throw InputError(
        "--check-points: has no effect: with [gear] contact = \"rigid\" no motion is integrated");
  study::RattleFile file(std::filesystem::path(options.place.out) / "rattle.partial.csv",
                         origin_of(the_case, rattle));
  study::RattleKeeping keeping;
  ReportFolders folders(options.place);
  const RunLock lock(std::filesystem::path(options.place.out) / "rattle.partial.lock",
                     RunLock::Kind::alone, "rattle map");
  if (options.resume) keeping.finished = file.read();
  if (options.resume && file.rows() == 0)
    std::fprintf(stderr, "bentaxis: %s: no rows to resume from; all are computed\n",
                 file.file().c_str());
  if (std::filesystem::exists(std::filesystem::path(options.place.out) / "rattle.csv"))
    std::fprintf(stderr, "bentaxis: %s holds an earlier map until this one is finished\n",
                 options.place.out.c_str());
  keeping.keep = [&](const study::RattleRow& row) { file.keep(row); };
  const auto say_kept = [&](const char* why) {
    std::fprintf(stderr, "bentaxis: %s%zu of %zu rows are in %s: --resume goes on from them\n", why,
                 file.rows(), rattle.delivery_bar.size(), file.file().c_str());
  };
  study::RattleMap map;
  std::vector<std::filesystem::path> paths;
  try {
    map = study::rattle_map(the_case, rattle, keeping, progress_of);
    paths =
        folders.write("report", study::rattle_document(map, versions(), described(map.the_case)),
                      {}, {{"rattle.csv", study::rattle_csv(map)}});
  } catch (const Interrupted&) {
    if (file.rows() > 0) {
      say_kept("interrupted; ");
    } else {
      if (!std::filesystem::exists(file.file())) throw;
      std::fprintf(stderr, "bentaxis: interrupted; %s still holds the rows of an earlier run\n",
                   file.file().c_str());
    }
    return kInterrupted;
  } catch (...) {
    if (file.rows() > 0) say_kept("");
    throw;
  }
  file.remove();
  print_result(study::rattle_text(map), paths);
  const auto failed = map.all_failed();
  return status_of_series(
      map.agrees() ? kDone : kOutOfTolerance, failed,
      failed.size() == map.failed.size()
          ? rattle.delivery_bar.size()
          : 2 * rattle.speed_rpm.size() * map.options.delivery_bar.size() + map.failed.size());
}

}  // namespace

Command add_rattle_command(CommandParser program) {
  auto options = std::make_shared<RattleCommandOptions>();
  auto command = program.subcommand(
      "rattle",
      "Map of gear or piston contact: loaded, reversing, out of contact, impacts on both sides");
  add_case(command, options->the_case);
  add_report(command, options->place, "report.html, report.json and rattle.csv");
  add_values(command, "--speeds", options->speeds, "shaft speeds, rpm").required();
  add_values(command, "--delivery-bar", options->delivery, "delivery pressures, bar").required();
  study::RattleOptions& map = options->rattle;
  command.option(
      "--turns", map.turns, Values::integers(1, 10000),
      "turns of the shaft that are evaluated; at a point whose motion does not repeat itself");
  command.option("--discard", map.discard, Values::integers(0, 10000),
                 "turns before those of --turns, at most");
  command.option(
      "--error", map.error, Values::numbers(1e-8, 1e-2, "NUMBER [1e-3]"),
      "wanted error of every reaction, relative to its peak; here of the tooth force, where no "
      "impact amplifies it");
  command.option("--check-points", map.check, Values::integers(0, 10000),
                 "number of points, spread over the classes, that Simbody computes too");
  add_threads(command, map.threads, "one row each, at most one per processor; 0: as many");
  command.flag("--resume", options->resume,
               "continue an interrupted run; with the rows that it has left in the directory");
  return {command, [options] { return rattle(*options); }};
}

}  // namespace bentaxis::cli

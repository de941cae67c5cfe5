#include <cstdio>
#include <filesystem>
#include <memory>

#include "bentaxis/study/reference_maker.h"
#include "commands.h"
#include "console.h"
#include "options.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  CaseOption the_case;
  std::string from, out, folder;
  int samples = study::kGoldenSamples;
};

int make_new(const Options& options) {
  const fs::path out = options.out.empty()
                           ? "reference_" + fs::path(options.the_case.file).stem().string()
                           : options.out;
  const study::NewReference made = study::make_reference(
      options.the_case.read(), !options.the_case.changes.empty(), options.from, out);
  for (const auto& path : made.files) std::printf("%s\n", path.c_str());
  std::printf(
      "%d of %zu columns recognised; complete description.toml, then: bentaxis regress %s\n",
      made.recognised, made.columns, out.c_str());
  return kDone;
}

int make_golden(const Options& options) {
  for (const auto& path :
       study::make_golden(options.the_case.read(), !options.the_case.changes.empty(),
                          options.samples, options.out, progress_of))
    std::printf("%s\n", path.c_str());
  return kDone;
}

int update(const Options& options) {
  const study::GoldenSet set = study::find_golden(options.folder);
  int changed = 0;
  for (const auto& description : set.golden) {
    const study::GoldenUpdate update = study::update_golden(description, progress_of);
    std::printf("%s", update.text.c_str());
    changed += update.rewritten ? 1 : 0;
  }
  std::printf("%d of %zu golden folders rewritten", changed, set.golden.size());
  if (set.others > 0)
    std::printf("; %d others (%s) are never written by the program", set.others, set.kinds.c_str());
  std::printf(".\n");
  return kDone;
}

}  // namespace

Command add_reference_command(CommandParser program) {
  auto options = std::make_shared<Options>();
  CommandParser command =
      program.subcommand("reference", "Make reference data for regress, and update golden curves");
  command.require_subcommand();
  CommandParser make = command.subcommand(
      "new", "Folder for a curve of another tool or a rig, with a guess at what its columns are");
  add_case(make, options->the_case);
  make.option("--from", options->from, "the curve (CSV, one header line)")
      .required()
      .text("CURVE.csv");
  make.option("--out", options->out, "new folder").text("DIR [reference_CASE]");
  CommandParser golden = command.subcommand(
      "golden", "Folder with the curves that both models give today, to detect changes");
  add_case(golden, options->the_case);
  golden.option("--samples", options->samples, "angles in the turn")
      .integer_in(3, 100000)
      .text("NUMBER [36]");
  golden.option("--out", options->out, "new folder").required().text("DIR");
  CommandParser renew = command.subcommand(
      "update", "Rewrite golden curves and say what changed; never touches other data");
  renew.option("dir", options->folder, "folder with references").required().text("DIR");
  return {command, [=] {
            if (make.parsed()) return make_new(*options);
            if (golden.parsed()) return make_golden(*options);
            return update(*options);
          }};
}

}  // namespace bentaxis::cli

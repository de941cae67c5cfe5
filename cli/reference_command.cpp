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

Command add_reference_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("reference", "Make reference data for regress, and update golden curves");
  command->require_subcommand(1);
  CLI::App* make = command->add_subcommand(
      "new", "Folder for a curve of another tool or a rig, with a guess at what its columns are");
  add_case(*make, options->the_case);
  make->add_option("--from", options->from, "the curve (CSV, one header line)")
      ->required()
      ->option_text("CURVE.csv");
  make->add_option("--out", options->out, "new folder")->option_text("DIR [reference_CASE]");
  CLI::App* golden = command->add_subcommand(
      "golden", "Folder with the curves that both models give today, to detect changes");
  add_case(*golden, options->the_case);
  golden->add_option("--samples", options->samples, "angles in the turn")
      ->check(CLI::Range(3, 100000))
      ->option_text("NUMBER [36]");
  golden->add_option("--out", options->out, "new folder")->required()->option_text("DIR");
  CLI::App* renew = command->add_subcommand(
      "update", "Rewrite golden curves and say what changed; never touches other data");
  renew->add_option("dir", options->folder, "folder with references")
      ->required()
      ->option_text("DIR");
  return {command, [=] {
            if (make->parsed()) return make_new(*options);
            if (golden->parsed()) return make_golden(*options);
            return update(*options);
          }};
}

}  // namespace bentaxis::cli

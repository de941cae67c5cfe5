#include <filesystem>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/kept_case.h"
#include "bentaxis/files/whole_file.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/study/reference_maker.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct ReferenceOptions {
  CaseOption the_case;
  std::string from, sheet, mapping, source, out, folder;
  bool accept = false;
  std::optional<double> tolerance;
  int samples = study::kGoldenSamples;
};

int make_new(const ReferenceOptions& options) {
  const std::string stem = "reference_" + fs::path(options.the_case.file).stem().string();
  const fs::path out = options.out.empty() ? stem : options.out;
  const bool changed = !options.the_case.changes.empty();
  const Case the_case = options.the_case.read();
  std::string description, proposals;
  if (!options.mapping.empty()) {
    if (options.accept) throw InputError("--accept takes the guess: it excludes --mapping");
    description = read_input_file(options.mapping, {"a mapping", kLargestSettings});
  } else {
    const study::MappingGuess guess = study::guess_reference(the_case, options.from, options.sheet);
    proposals = study::proposal_text(guess) + std::to_string(guess.recognised()) + " of " +
                counted(guess.recognised() + guess.ignored.size(), "column") + " recognised\n";
    description = study::description_of(guess, options.source, options.tolerance);
    if (options.accept && !guess.unrecognised.empty())
      throw InputError(
          options.from + ": \"" + joined(guess.unrecognised, "\", \"") + "\"" +
          word_for(guess.unrecognised.size(), ": this column is", ": these columns are") +
          " not recognised, although the names or sizes say a channel: --accept takes "
          "no such guess. Run the command without --accept, edit the proposal and "
          "give it by --mapping");
    if (!options.accept) {
      const fs::path proposal = out.parent_path() / (out.filename().string() + "_mapping.toml");
      if (fs::exists(proposal))
        throw InputError(proposal.string() +
                         ": exists; use it by --mapping, or take it away for a new guess");
      write_whole(proposal, description);
      std::printf("%s", proposals.c_str());
      std::printf("%s: %s, then: bentaxis reference new .. --mapping %s%s\n", proposal.c_str(),
                  guess.unrecognised.empty() ? "confirm or edit it"
                                             : "state in it what the undecided columns are",
                  proposal.c_str(), guess.unrecognised.empty() ? " (or --accept the guess)" : "");
      return kDone;
    }
  }
  const auto paths = study::make_reference(the_case, changed, options.from, description, out,
                                           options.mapping, progress_of);
  std::printf("%s", proposals.c_str());
  print_files(paths);
  std::printf("now: bentaxis regress %s\n", out.c_str());
  return kDone;
}

int make_golden(const ReferenceOptions& options) {
  print_files(study::make_golden(options.the_case.read(), !options.the_case.changes.empty(),
                                 options.samples, options.out, progress_of));
  return kDone;
}

int update(const ReferenceOptions& options) {
  const study::GoldenSet set = study::find_golden(options.folder);
  int changed = 0;
  for (std::size_t i = 0; i < set.golden.size(); ++i) {
    study::GoldenUpdate update;
    try {
      update = study::update_golden(set.golden[i], progress_of);
    } catch (const Interrupted&) {
      std::fprintf(stderr,
                   "bentaxis: interrupted after %zu of %zu golden folders, of which %d were "
                   "rewritten; do the same again for the rest\n",
                   i, set.golden.size(), changed);
      return kInterrupted;
    }
    std::printf("%s", update.text.c_str());
    changed += update.rewritten ? 1 : 0;
  }
  std::printf("%d of %s rewritten", changed, counted(set.golden.size(), "golden folder").c_str());
  if (set.others > 0)
    std::printf("; %s (%s) %s never written by the program", counted(set.others, "other").c_str(),
                set.kinds.c_str(), word_for(set.others, "is", "are").c_str());
  std::printf(".\n");
  return kDone;
}

}  // namespace

Command add_reference_command(CommandParser program) {
  auto options = std::make_shared<ReferenceOptions>();
  auto command =
      program.subcommand("reference", "Make reference data for regress, and update golden curves");
  command.require_subcommand();
  auto make = command.subcommand(
      "new", "Folder for a record of another tool or a rig, with a guess at what its columns are");
  add_case(make, options->the_case);
  make.option("--from", options->from, Values("FILE").required(),
              "the record: text, ADAMS table or request file, .xlsx, .mat");
  make.option("--sheet", options->sheet, "NAME [the first with a table]",
              "sheet of a workbook, variable of a MATLAB file");
  auto mapping =
      make.option("--mapping", options->mapping, "FILE.toml",
                  "what the columns are: a proposal of this command, confirmed or edited");
  make.flag("--accept", options->accept, "take the guess as it is");
  make.option("--source", options->source, "TEXT", "which tool or rig, which version, who, when")
      .excludes(mapping);
  make.option("--tolerance", options->tolerance,
              Values::positive("NUMBER [what the digits of the file allow]", 1),
              "largest difference over a reaction's peak that counts as agreement")
      .excludes(mapping);
  make.option("--out", options->out, "DIR [reference_CASE]",
              "where results are written; new directory");
  auto golden = command.subcommand(
      "golden", "Folder with the curves that both models give today, to detect changes");
  add_case(golden, options->the_case);
  golden.option("--angles", options->samples, Values::integers(3, 100000),
                "angles per turn at which results are taken");
  golden.option("--out", options->out, Values("DIR").required(),
                "where results are written; new directory");
  auto renew = command.subcommand(
      "update", "Rewrite golden curves and say what changed; never touches other data");
  renew.option("dir", options->folder, Values("DIR").required(), "folder with references");
  const std::string group = "Commands";
  make.place(group,
             "bentaxis run bap63_rated --model analytic --out record\n"
             "  bentaxis reference new bap63_rated --from record/analytic.csv --accept");
  golden.place(group, "bentaxis reference golden bap63_rated --out golden");
  renew.place(group, "bentaxis reference update golden");
  return {command, [=] {
            if (make.parsed()) return make_new(*options);
            if (golden.parsed()) return make_golden(*options);
            return update(*options);
          }};
}

}  // namespace bentaxis::cli

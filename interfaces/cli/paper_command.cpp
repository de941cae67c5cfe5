// bentaxis paper: the curves and drawings of the paper as one page.
#include <cstdio>
#include <memory>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/paper_figures.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "report_files.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

struct PaperOptions {
  ReportPlace place;
  std::string list;
};

int paper(const PaperOptions& options) {
  const auto data = shipped_reference_data();
  if (!data) throw InputError("the shipped cases are not there");
  const study::PaperFigures list = study::read_paper_figures(
      options.list.empty() ? *data / "published" / "bap63" / "figures.toml"
                           : std::filesystem::path(options.list));
  ReportFolders folders(options.place);
  const study::PaperStudy result =
      study::run_paper_study(list, data->parent_path() / "cases", progress_of);
  const auto paths = folders.write(
      "paper",
      study::paper_document(result, versions(), study::describe(result.cases.front(), progress_of)),
      {}, {{"paper.csv", study::paper_csv(result)}});
  std::printf("%s\n", study::paper_text(result).c_str());
  for (const auto& path : paths) std::printf("%s\n", path.c_str());
  return kDone;
}

}  // namespace

Command add_paper_command(CommandParser program) {
  auto options = std::make_shared<PaperOptions>();
  CommandParser command = program.subcommand(
      "paper", "The paper's curves and drawings by both models, in its printed axes");
  add_report(command, options->place, "paper.html, paper.json and paper.csv");
  command
      .option("--list", options->list,
              "another list of figures, beside the printed numbers that it names")
      .text("FILE [the shipped figures.toml]");
  return {command, [options] { return paper(*options); }};
}

}  // namespace bentaxis::cli

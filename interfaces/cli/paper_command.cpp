// bentaxis paper: the curves and drawings of the paper as one page.
#include "bentaxis/study/paper_figures.h"
#include "command_tools.h"

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
  folders.publish("paper", study::paper_text(result),
                  study::paper_document(result, versions(), described(result.cases.front())),
                  {{"paper.csv", study::paper_csv(result)}});
  return kDone;
}

}  // namespace

Command add_paper_command(CommandParser program) {
  auto options = std::make_shared<PaperOptions>();
  auto command = program.subcommand(
      "paper", "The paper's curves and drawings by both models, in its printed axes");
  add_report(command, options->place, "paper.html, paper.json and paper.csv");
  command.option("--list", options->list, "FILE [the shipped figures.toml]",
                 "another list of figures, beside the printed numbers that it names");
  return {command, [options] { return paper(*options); }};
}

}  // namespace bentaxis::cli

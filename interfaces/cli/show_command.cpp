// bentaxis show: the pump of a case, by its dimensions and by the analytic model alone.
#include <filesystem>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/pump_document.h"
#include "bentaxis/study/pump_picture.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct ShowOptions {
  CaseOption the_case;
  std::string out, figures;

  bool picture_alone() const { return fs::path(out).extension() == ".svg"; }
  bool report() const { return !out.empty() && !picture_alone(); }
};

void write_picture(const Case& the_case, const std::string& file) {
  write_file(file, study::pump_picture(the_case));
  std::printf("%s\n", file.c_str());
}

int show(const ShowOptions& options) {
  const Case the_case = options.the_case.read();
  std::optional<ReportFolders> report;
  std::optional<OutputFolder> figures;
  if (options.report())
    report.emplace(ReportPlace{options.out, options.figures});
  else if (!options.figures.empty())
    figures.emplace(options.figures);

  std::optional<study::ShownPump> pump;
  if (report || figures) pump = study::show_pump(the_case, progress_of);
  std::printf("%s\n", the_case.name.c_str());
  if (pump) {
    for (const std::string& answer : pump->answers()) std::printf("%s\n", answer.c_str());
    std::printf("\n");
  }
  // Where the load sets the delivery pressure, that is known once it has been computed.
  for (const auto& quantity : study::derived_section(pump ? pump->ready.the_case : the_case))
    std::printf("  %-22s %10.5g %s\n", quantity.name.c_str(), quantity.value,
                quantity.unit.c_str());
  if (!pump) {
    if (options.picture_alone()) write_picture(the_case, options.out);
    return kDone;
  }
  const report::Document document = study::pump_document(*pump, versions());
  const report::Curves curves = study::pump_curves(*pump);
  if (figures) {
    add_figure_files(*figures, document, curves);
    if (options.picture_alone()) write_picture(the_case, options.out);
    std::printf("%s\n", commit_figures(*figures).c_str());
    return kDone;
  }
  print_files(
      report->write("report", document, curves, {{"analytic.csv", to_csv(pump->run.table)}}));
  return kDone;
}

}  // namespace

Command add_show_command(CommandParser program) {
  auto options = std::make_shared<ShowOptions>();
  auto command =
      program.subcommand("show",
                         "Describe the pump of a case with its plausibility warnings and draw it "
                         "to scale; with forces by the analytic model only");
  add_case(command, options->the_case);
  command.option("--out", options->out, "FILE.svg|DIR",
                 "where results are written; the picture, or a directory for a report with forces "
                 "and curves of the analytic model alone");
  add_figures(command, options->figures);
  return {command, [options] { return show(*options); }};
}

}  // namespace bentaxis::cli

// --out and --figures: the part of report_files.h that knows the parser.
#include "options.h"
#include "report_files.h"

namespace bentaxis::cli {

void add_report(const CommandParser& command, ReportPlace& place, const std::string& what) {
  add_out(command, place.out, what);
  add_figures(command, place.figures);
}

void add_figures(CommandParser command, std::string& folder) {
  command.option("--figures", folder, "DIR",
                 "also write every figure of the report as SVG, PNG and CSV into this folder, made "
                 "where missing");
}

}  // namespace bentaxis::cli

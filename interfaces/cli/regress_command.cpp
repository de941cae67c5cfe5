#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/designs/explain.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/report/page.h"
#include "bentaxis/study/comparison_answers.h"
#include "bentaxis/study/piece_progress.h"
#include "bentaxis/study/regression.h"
#include "bentaxis/study/regression_document.h"
#include "command_tools.h"
#include "provenance.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct RegressOptions {
  std::string folder, junit, html, json, filter;
  ReportPlace place;
};

// In the order of study::Outcome::State.
constexpr ExitStatus kStatuses[] = {kDone, kOutOfTolerance, kBadInput, kComputationFailed};

int regress(const RegressOptions& options) {
  const auto shipped = shipped_reference_data();
  if (options.folder.empty() && !shipped)
    throw InputError("no reference data are installed with this program: name a folder");
  const fs::path root = options.folder.empty() ? *shipped : fs::path(options.folder);
  std::vector<study::ReferencePlace> places = study::references_below(root);
  const std::size_t all = places.size();
  std::erase_if(places, [&](const auto& place) {
    return place.name.find(options.filter) == std::string::npos;
  });
  if (places.empty())
    throw InputError(fmt::format("--filter \"{}\" leaves none of the {} cases below {}",
                                 options.filter, all, root.string()));
  std::optional<ReportFolders> folders;
  if (!options.place.out.empty()) folders.emplace(options.place);
  std::vector<study::Outcome> outcomes;
  int status = kDone;
  // Of a single reference how far it is, of several how many are done.
  const Progress whole = progress_of(fmt::format("{} references", places.size()));
  const auto part = [&](const std::string& name) {
    if (places.size() == 1) return progress_of(name);
    return Progress([&](double) { study::within(whole, outcomes.size(), places.size())(0); });
  };
  for (const auto& place : places) {
    study::Outcome outcome = study::hold(place, part);
    designs::explain(outcome, place, part);
    status = std::max<int>(status, kStatuses[static_cast<int>(outcome.state)]);
    if (!outcome.error.empty()) {
      whole(1);  // clears the line
      std::fprintf(stderr, "bentaxis: %s: %s\n", outcome.name.c_str(), outcome.error.c_str());
    }
    outcomes.push_back(std::move(outcome));
    whole(static_cast<double>(outcomes.size()) / static_cast<double>(places.size()));
  }
  std::printf("%s", study::regression_report(outcomes).c_str());
  std::vector<report::TestSuite> suites;
  for (const auto& outcome : outcomes) suites.push_back(study::suite_of(outcome));
  const std::string junit = report::junit_xml("bentaxis regress", suites);
  if (!options.junit.empty()) write_file(options.junit, junit);
  if (options.html.empty() && options.json.empty() && options.place.figures.empty() && !folders)
    return status;
  const std::string name = fs::absolute(root / ".").parent_path().filename();
  report::Document document = study::regression_document(outcomes, name, versions());
  if (folders) print_files(folders->write("report", document, {}, {{"junit.xml", junit}}));
  add_provenance(document);
  for (const std::string& file : {options.html, options.json})
    if (!file.empty()) document.files.push_back(fs::path(file).filename());
  if (!options.html.empty()) write_file(options.html, report::render_page(document));
  if (!options.json.empty()) write_file(options.json, report::json_text(document));
  if (!options.place.figures.empty() && !folders) {
    OutputFolder folder(options.place.figures);
    add_figure_files(folder, document);
    commit_figures(folder);
  }
  return status;
}

}  // namespace

Command add_regress_command(CommandParser program) {
  auto options = std::make_shared<RegressOptions>();
  auto command = program.subcommand(
      "regress", "Compare both models with stored curves: the shipped reference data or your own");
  command.option("dir", options->folder, "[DIR]",
                 "directory with references (default: the shipped set)");
  options->place.out.clear();  // nothing is written where it is not given
  add_report(command, options->place, "report.html, report.json and junit.xml");
  command.option("--junit", options->junit, "FILE", "write the results as JUnit XML");
  command.option(
      "--html", options->html, "FILE",
      "write a page with the curves that differ and every external curve, over both models");
  command.option(
      "--json-file", options->json, "FILE",
      "write the same as JSON (docs/report_json.md); beside the page, for `bentaxis index`");
  command.option("--filter", options->filter, "TEXT", "only cases whose name contains this text");
  return {command, [options] { return regress(*options); }};
}

}  // namespace bentaxis::cli

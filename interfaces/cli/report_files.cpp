#include "report_files.h"

#include <algorithm>
#include <cstdio>

#include "bentaxis/hydraulics/accuracy_log.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/picture.h"
#include "bentaxis/study/timing.h"
#include "provenance.h"

namespace bentaxis::cli {
namespace {

constexpr const char* kFigureList = "figures.csv";
constexpr const char* kFigureListHead = "file,figure,paper,title\n";
constexpr const char* kFormerHead = "figure,title\n";  // of a list by an earlier version

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, "\"");
  return "\"" + text + "\"";
}

// The files that a list of figures names.
std::vector<std::string> files_of_list(const std::string& list) {
  std::vector<std::string> names;
  if (!list.starts_with(kFigureListHead) && !list.starts_with(kFormerHead)) return names;
  for (std::size_t at = list.find('\n') + 1; at < list.size(); at = list.find('\n', at) + 1) {
    const std::string file = list.substr(at, list.find(',', at) - at);
    for (const char* type : {".svg", ".png", ".csv"}) names.push_back(file + type);
    if (list.find('\n', at) == std::string::npos) break;
  }
  return names;
}

// A pressure that is less accurate than its case allows is a warning of every report.
void add_accuracy(report::Document& document) {
  const auto warning = study::accuracy_warning(hydraulics::AccuracyLog::record());
  if (!warning) return;
  auto& all = document.warnings ? *document.warnings : document.warnings.emplace();
  const bool there = std::any_of(all.begin(), all.end(), [&](const report::Warning& other) {
    return other.name == warning->name;
  });
  if (!there) all.push_back(*warning);
}

}  // namespace

std::vector<TextFile> text_files(std::vector<std::pair<std::string, std::string>> files) {
  std::vector<TextFile> all;
  for (auto& file : files) all.emplace_back(std::move(file));
  return all;
}

ReportFolders::ReportFolders(const ReportPlace& place) : report_(place.out) {
  if (!place.figures.empty()) figures_.emplace(place.figures);
}

std::vector<std::filesystem::path> ReportFolders::write(const std::string& name,
                                                        report::Document document,
                                                        const report::Curves& curves,
                                                        const std::vector<TextFile>& further) {
  add_provenance(document);
  add_accuracy(document);
  document.files = report_.names();
  document.files.insert(document.files.begin(), name + ".html");
  for (const TextFile& file : further) document.files.push_back(file.name);
  document.files.push_back(name + ".json");
  report_.add(name + ".html", report::render_page(document, curves));
  for (const TextFile& file : further) {
    OutputFolder::Stream& stream = report_.open(file.name);
    file.write([&](const std::string& piece) { stream.write(piece); });
    stream.finish();
  }
  report_.add(name + ".json", report::json_text(document));  // last: it is the record of the set
  if (figures_) add_figure_files(*figures_, document, curves);
  auto paths = report_.commit(name + ".json", report::files_of);
  if (figures_) paths.push_back(commit_figures(*figures_));
  return paths;
}

void ReportFolders::publish(const std::string& name, const std::string& text,
                            const report::Document& document, const std::vector<TextFile>& further,
                            const report::Curves& curves) {
  print_result(text, write(name, document, curves, further));
}

void print_files(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) std::printf("%s\n", file.c_str());
}

void print_result(const std::string& text, const std::vector<std::filesystem::path>& files) {
  std::printf("%s\n", text.c_str());
  print_files(files);
}

void add_figure_files(OutputFolder& folder, const report::Document& document,
                      const report::Curves& curves) {
  std::string list = kFigureListHead;
  for (const report::Figure& figure : document.figures.value_or(std::vector<report::Figure>())) {
    const std::string svg = report::svg_of(figure, curves);
    const std::string file = report::file_name_of(figure);
    folder.add(file + ".svg", svg);
    folder.add(file + ".png", report::png_of(svg));
    folder.add(file + ".csv", report::csv_of(figure, curves));
    list += file + "," + figure.id + "," + quoted(figure.paper) + "," + quoted(figure.title) + "\n";
  }
  folder.add(kFigureList, list);
}

std::filesystem::path commit_figures(OutputFolder& folder) {
  return folder.commit(kFigureList, files_of_list).back();
}

}  // namespace bentaxis::cli

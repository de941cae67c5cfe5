// bentaxis index: one page over a folder of reports.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/report/index.h"
#include "commands.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct IndexOptions {
  std::string folder, out;
};

// JSON files below a folder, by their path from it, in order.
std::vector<fs::path> json_files(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  std::vector<fs::path> files;
  try {
    for (const auto& entry :
         fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied))
      // A link to itself is no file.
      if (std::error_code none; entry.path().extension() == ".json" && entry.is_regular_file(none))
        files.push_back(entry.path());
  } catch (const fs::filesystem_error& error) {
    throw InputError(error.path1().string() + ": cannot be read: " + error.code().message());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Nothing where it cannot be read: it is then no report.
std::string text_of(const fs::path& file) {
  try {
    return read_input_file(file, {"a report", kLargestReport});
  } catch (const InputError&) {
    return {};
  }
}

int index(const IndexOptions& options) {
  const fs::path folder = options.folder;
  const fs::path out = options.out.empty() ? folder : fs::path(options.out);
  const fs::path own = fs::weakly_canonical(out) / "index.json";
  std::vector<report::IndexEntry> entries;
  std::vector<std::string> skipped;
  for (const fs::path& file : json_files(folder)) {
    if (fs::weakly_canonical(file) == own) continue;  // of an earlier index
    auto entry = report::index_entry(text_of(file));
    const fs::path from = fs::absolute(file).lexically_normal().lexically_relative(
        fs::absolute(out).lexically_normal());
    if (!entry) {
      skipped.push_back(from.generic_string());
      continue;
    }
    entry->json = from.generic_string();
    const fs::path page = entry->page.empty() ? fs::path() : file.parent_path() / entry->page;
    entry->page.clear();
    if (!page.empty() && fs::is_regular_file(page)) {
      entry->page = (from.parent_path() / page.filename()).generic_string();
      entry->picture = report::picture_of_page(text_of(page));
    }
    entries.push_back(std::move(*entry));
  }
  if (entries.empty())
    throw InputError(options.folder + ": no report below it (a .json file that a command wrote)");
  report::sort_by_worst(entries);
  OutputFolder output(out);
  output.add("index.html", report::index_page("Reports in " + options.folder, entries, skipped));
  output.add("index.json", report::index_json(entries));
  const auto paths = output.commit();
  std::printf("%s\n\n", without_control_characters(report::index_headline(entries)).c_str());
  for (const report::IndexEntry& e : entries) {
    const std::string warned =
        e.warnings.empty() ? "" : " (warnings: " + std::to_string(e.warnings.size()) + ")";
    std::printf("%-10s %s: %s%s\n",
                !e.agrees   ? "-"
                : *e.agrees ? "agrees"
                            : "differs",
                without_control_characters(e.json).c_str(),
                without_control_characters(e.headline.empty() ? e.title : e.headline).c_str(),
                warned.c_str());
  }
  if (!skipped.empty())
    std::printf("%zu JSON files are no report and were left out\n", skipped.size());
  std::printf("%s\n", paths.front().c_str());
  return kDone;
}

}  // namespace

Command add_index_command(CommandParser program) {
  auto options = std::make_shared<IndexOptions>();
  CommandParser command =
      program.subcommand("index", "One page over all reports below a folder, the worst first");
  command.option("DIR", options->folder, "directory with reports in its subdirectories").required();
  command
      .option("--out", options->out,
              "where results are written; directory for index.html and index.json")
      .text("DIR [DIR]");
  return {command, [options] { return index(*options); }};
}

}  // namespace bentaxis::cli

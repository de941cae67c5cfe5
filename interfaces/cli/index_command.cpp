// bentaxis index: one page over a folder of reports.
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/report/index.h"
#include "command_tools.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct IndexOptions {
  std::string folder, out;
};

struct FoundFiles {
  std::vector<fs::path> json;  // in order
  std::vector<std::pair<fs::path, std::string>> unread;
};

// What is below a folder. A link to itself is no file, and a link to a folder is not followed.
void search(const fs::path& folder, FoundFiles& found) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  for (const fs::directory_iterator end; !error && entries != end; entries.increment(error)) {
    const fs::directory_entry& entry = *entries;
    std::error_code reason, none;
    const fs::file_status status = entry.status(reason);
    const bool is_json = entry.path().extension() == ".json";
    if (fs::is_directory(status) && !entry.is_symlink(none))
      search(entry.path(), found);
    else if (is_json && fs::is_regular_file(status))
      found.json.push_back(entry.path());
    else if (is_json && reason == std::errc::permission_denied)
      found.unread.emplace_back(entry.path(), reason.message());
    else if (is_json && status.type() == fs::file_type::not_found && entry.is_symlink(none))
      found.unread.emplace_back(entry.path(), "a link to a file that does not exist");
  }
  if (error) found.unread.emplace_back(folder, "cannot be read: " + error.message());
}

FoundFiles files_below(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  FoundFiles found;
  search(folder, found);
  std::sort(found.json.begin(), found.json.end());
  std::sort(found.unread.begin(), found.unread.end());
  return found;
}

// The text, or why there is none.
struct ReadText {
  std::string text, reason;
};

ReadText read_report(const fs::path& file) {
  try {
    return {read_input_file(file, {"a report", kLargestReport}), {}};
  } catch (const InputError& error) {
    std::string reason = error.what();
    const std::string name = file.string() + ": ";
    return {{}, reason.starts_with(name) ? reason.substr(name.size()) : reason};
  }
}

// Where a path leads to from a folder.
std::string path_from(const fs::path& out, const fs::path& file) {
  return fs::absolute(file)
      .lexically_normal()
      .lexically_relative(fs::absolute(out).lexically_normal())
      .generic_string();
}

// " (and 2 more)".
std::string more_of(std::size_t count) {
  return count < 2 ? "" : " (and " + std::to_string(count - 1) + " more)";
}

// Before the name of a report: whether it agrees, or what is wrong instead.
std::string mark_of(const report::IndexEntry& entry) {
  if (!entry.agrees) return "-";
  if (*entry.agrees) return "agrees";
  return report::index_fault(entry);
}

int index(const IndexOptions& options) {
  const fs::path folder = options.folder;
  const fs::path out = options.out.empty() ? folder : fs::path(options.out);
  const fs::path own = fs::weakly_canonical(out) / "index.json";
  std::vector<report::IndexEntry> entries;
  std::vector<std::string> skipped;
  std::vector<report::UnreadFile> unread;
  const FoundFiles found = files_below(folder);
  for (const auto& [file, reason] : found.unread) unread.push_back({path_from(out, file), reason});
  for (const fs::path& file : found.json) {
    if (fs::weakly_canonical(file) == own) continue;  // of an earlier index
    const ReadText read = read_report(file);
    const std::string damage = read.reason.empty() ? report::damage_of(read.text) : read.reason;
    if (!damage.empty()) {
      unread.push_back({path_from(out, file), damage});
      continue;
    }
    auto entry = report::index_entry(read.text);
    const fs::path from = path_from(out, file);
    if (!entry) {
      skipped.push_back(from.generic_string());
      continue;
    }
    entry->json = from.generic_string();
    const fs::path page = entry->page.empty() ? fs::path() : file.parent_path() / entry->page;
    entry->page.clear();
    if (!page.empty() && fs::is_regular_file(page)) {
      entry->page = (from.parent_path() / page.filename()).generic_string();
      entry->picture = report::picture_of_page(read_report(page).text);
    }
    entries.push_back(std::move(*entry));
  }
  std::sort(unread.begin(), unread.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  if (entries.empty() && unread.empty())
    throw InputError(options.folder + ": no report below it (a .json file that a command wrote)");
  if (entries.empty())
    throw InputError(options.folder + ": no report below it can be read: " + unread.front().path +
                     ": " + unread.front().reason + more_of(unread.size()));
  report::sort_by_worst(entries);
  OutputFolder output(out);
  output.add("index.html",
             report::index_page("Reports in " + options.folder, entries, skipped, unread));
  output.add("index.json", report::index_json(entries, unread));
  const auto paths = output.commit();
  std::printf("%s\n\n",
              without_control_characters(report::index_headline(entries, unread)).c_str());
  for (const report::UnreadFile& file : unread)
    std::printf("%-10s %s: %s\n", "not read", without_control_characters(file.path).c_str(),
                without_control_characters(file.reason).c_str());
  for (const report::IndexEntry& e : entries) {
    const std::string warned =
        e.warnings.empty() ? "" : " (warnings: " + std::to_string(e.warnings.size()) + ")";
    const std::string beyond = e.not_valid.empty() ? "" : "; not valid " + e.not_valid;
    std::printf("%-10s %s: %s%s%s\n", mark_of(e).c_str(),
                without_control_characters(e.json).c_str(),
                without_control_characters(e.headline.empty() ? e.title : e.headline).c_str(),
                without_control_characters(beyond).c_str(), warned.c_str());
  }
  if (!skipped.empty())
    std::printf("%zu JSON files are no report and were left out\n", skipped.size());
  std::printf("%s\n", paths.front().c_str());
  if (unread.empty()) return kDone;
  throw InputError(options.folder + ": not all below it can be read: " + unread.front().path +
                   ": " + unread.front().reason + more_of(unread.size()) +
                   "; the others are in the page");
}

}  // namespace

Command add_index_command(CommandParser program) {
  auto options = std::make_shared<IndexOptions>();
  auto command =
      program.subcommand("index", "One page over all reports below a folder, the worst first");
  command.option("DIR", options->folder, Values().required(),
                 "directory with reports in its subdirectories");
  command.option("--out", options->out, "DIR [DIR]",
                 "where results are written; directory for index.html and index.json");
  return {command, [options] { return index(*options); }};
}

}  // namespace bentaxis::cli

#include "shipped_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/words.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".toml";

std::string group_of(const Case& the_case) {
  const bool hydraulic = the_case.pressure.kind == PressureKind::hydraulic;
  return std::string(the_case.drive ? "Motion in time" : "Constant speed") +
         (hydraulic ? ", hydraulic model" : ", given pressure");
}

}  // namespace

std::vector<std::string> case_names(const std::optional<fs::path>& folder) {
  std::vector<std::string> names;
  std::error_code error;
  if (folder)
    for (const auto& entry : fs::directory_iterator(*folder, error))
      if (entry.path().extension() == kEnding) names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<ShippedCase> cases_in(const fs::path& folder) {
  std::vector<ShippedCase> cases;
  for (const std::string& name : case_names(folder)) {
    const fs::path file = folder / (name + kEnding);
    const Case the_case = read_case(file);
    cases.push_back({name, the_case.name, group_of(the_case), file});
  }
  std::stable_sort(cases.begin(), cases.end(),
                   [](const auto& a, const auto& b) { return a.group < b.group; });
  return cases;
}

std::string case_file(const std::string& text, const std::optional<fs::path>& folder) {
  std::error_code error;
  const fs::path path = text;
  if (text.empty() || fs::exists(path, error)) return text;
  if (path.has_parent_path() || path.has_extension()) {
    // As the documents write it: cases/NAME.toml, which is here where the sources are.
    if (folder && path.lexically_relative("cases") == path.filename() &&
        fs::exists(*folder / path.filename(), error))
      throw InputError(text + ": cannot be read: no such file; the shipped case is " +
                       path.stem().string());
    return text;
  }
  if (folder && fs::exists(*folder / "studies" / (text + kEnding), error))
    return (*folder / "studies" / (text + kEnding)).string();
  const std::vector<std::string> names = case_names(folder);
  if (contains(names, text)) return (*folder / (text + kEnding)).string();
  if (names.empty()) return text;
  throw InputError(text + ": neither a file nor a shipped case" +
                   suggestion(text, {names.begin(), names.end()}, "by `bentaxis cases`"));
}

std::string cases_text(const std::vector<ShippedCase>& cases) {
  std::size_t width = 0;
  for (const ShippedCase& one : cases) width = std::max(width, one.name.size());
  std::string text, group;
  for (const ShippedCase& one : cases) {
    if (one.group != group) text += (text.empty() ? "" : "\n") + one.group + "\n";
    group = one.group;
    text += fmt::format("  {:{}}  {}\n", one.name, width, one.title);
  }
  return text;
}

std::string cases_json(const std::vector<ShippedCase>& cases) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ShippedCase& one : cases)
    list.push_back({{"name", one.name},
                    {"title", one.title},
                    {"group", one.group},
                    {"file", one.file.string()}});
  return list.dump(2) + "\n";
}

}  // namespace bentaxis::cli

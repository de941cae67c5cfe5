#include "bentaxis/study/problem.h"

#include <algorithm>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription = "problem.toml";
constexpr NumberRange kTolerance{0, 1, true, false};

std::size_t column_of(const Problem& problem, const std::string& name, const fs::path& file) {
  for (std::size_t c = 0; c < problem.columns.size(); ++c)
    if (problem.columns[c].name == name) return c;
  throw InputError(file.string() + ": column \"" + name + "\" is not in " + kDescription);
}

void read_description(Problem& problem) {
  const TomlFile file = TomlFile::read(problem.folder / kDescription, "description of a problem");
  TableReader in = file.root();
  in.integer("schema", 1, 1);
  problem.title = in.text("title");
  problem.tolerance = in.number("tolerance", kTolerance);
  in.integer("digits", 1, 40);
  TableReader grid = in.table("grid");
  problem.over = grid.text("column");
  const double from = grid.number("from", kAny), step = grid.number("step", kPositive);
  const int count = grid.integer("count", 13, 100000);
  problem.period = grid.number("period", kPositive, 0.0);
  problem.smooth = grid.flag("smooth", true);
  grid.finish();
  for (int i = 0; i < count; ++i) problem.grid.push_back(from + step * i);
  in.table("data");  // for those who solve it
  for (TableReader& column : in.tables("column")) {
    ProblemColumn c;
    c.name = column.text("name");
    c.vector = column.text("vector");
    c.meaning = column.text("meaning");
    c.on = column.text("on", "");
    c.by = column.text("by", "");
    c.at = column.text("at", "");
    c.frame = column.text("frame", "");
    column.finish();
    problem.columns.push_back(std::move(c));
  }
  if (problem.columns.empty()) in.fail("column", "at least one [[column]] is needed");
  for (TableReader& mistake : in.tables("mistake")) {
    problem.mistakes.push_back({mistake.text("key"), mistake.text("says"), {}});
    mistake.finish();
  }
  in.finish();
}

void read_curves(Problem& problem) {
  const fs::path file = problem.folder / "curves.csv";
  const NumericTable table = read_numeric_csv(file);
  if (table.header.empty() || table.header.front() != problem.over ||
      table.rows.size() != problem.grid.size())
    throw InputError(file.string() + ": must have " + std::to_string(problem.grid.size()) +
                     " rows over " + problem.over);
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    if (table.rows[r][0] != problem.grid[r])
      throw InputError(file.string() + ":" + std::to_string(table.lines[r]) + ": " + problem.over +
                       " is not " + number_text(problem.grid[r]));
  for (std::size_t c = 1; c < table.header.size(); ++c) {
    auto& values = problem.columns[column_of(problem, table.header[c], file)].values;
    for (const auto& row : table.rows) values.push_back(row[c]);
  }
  for (const ProblemColumn& column : problem.columns)
    if (column.values.size() != problem.grid.size())
      throw InputError(file.string() + ": has no column \"" + column.name + "\", or two of them");
}

void read_checks(Problem& problem) {
  const fs::path file = problem.folder / "checks.csv";
  const std::string content = read_input_file(file, {"checks of a problem", kLargestTable});
  std::size_t begin = content.find('\n');
  while (begin != std::string::npos && begin + 1 < content.size()) {
    const std::size_t end = content.find('\n', begin + 1);
    const std::string line = content.substr(begin + 1, end - begin - 1);
    begin = end;
    std::vector<std::string> fields(1);
    for (const char letter : line)
      if (letter == ',')
        fields.emplace_back();
      else
        fields.back() += letter;
    const auto number = [&](std::size_t i) {
      const auto value = i < fields.size() ? number_in(fields[i]) : std::nullopt;
      if (!value) throw InputError(file.string() + ": \"" + line + "\": is not a line of checks");
      return *value;
    };
    ProblemColumn& column = problem.columns[column_of(problem, fields.front(), file)];
    column.peak = number(1);
    column.digits = static_cast<int>(number(2));
    column.spread = number(3);
  }
  for (const ProblemColumn& column : problem.columns)
    if (!(column.peak > 0))
      throw InputError(file.string() + ": has no peak of column \"" + column.name + "\"");
}

void read_mistakes(Problem& problem) {
  const fs::path file = problem.folder / "mistakes.csv";
  const NumericTable table = read_numeric_csv(file);
  for (const auto& row : table.rows) {
    const auto at = std::find(problem.grid.begin(), problem.grid.end(), row.front());
    if (at == problem.grid.end())
      throw InputError(file.string() + ": " + number_text(row.front()) + " is not a value of " +
                       problem.over + " in curves.csv");
    problem.mistake_rows.push_back(static_cast<std::size_t>(at - problem.grid.begin()));
  }
  for (std::size_t c = 1; c < table.header.size(); ++c) {
    const std::string& name = table.header[c];
    const std::size_t colon = name.find(':');
    const auto mistake =
        std::find_if(problem.mistakes.begin(), problem.mistakes.end(),
                     [&](const KnownMistake& one) { return one.key == name.substr(0, colon); });
    if (colon == std::string::npos || mistake == problem.mistakes.end())
      throw InputError(file.string() + ": column \"" + name + "\" is no mistake of problem.toml");
    auto& curve = mistake->curves[column_of(problem, name.substr(colon + 1), file)];
    for (const auto& row : table.rows) curve.push_back(row[c]);
  }
}

}  // namespace

Problem read_problem(const fs::path& folder) {
  Problem problem;
  // The description stands for its folder.
  problem.folder = folder.filename() == kDescription ? folder.parent_path() : folder;
  problem.name = fs::absolute(problem.folder / ".").parent_path().filename();
  read_description(problem);
  read_curves(problem);
  read_checks(problem);
  read_mistakes(problem);
  return problem;
}

std::vector<std::string> problem_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (fs::exists(entry.path() / kDescription, error)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace bentaxis::study

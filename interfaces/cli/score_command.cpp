#include "bentaxis/files/whole_file.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/words.h"
#include "command_tools.h"
#include "score_files.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

struct ScoreOptions {
  std::string file, problem, badge;
  std::optional<double> tolerance;
  bool json = false;
};

study::Problem problem_of(const std::string& text) {
  const fs::path path = text;
  std::error_code error;
  if (path.has_parent_path() || fs::is_directory(path, error)) return study::read_problem(path);
  const auto folder = shipped_problems();
  if (!folder) throw InputError("no problems are installed with this program: name a folder");
  const auto names = study::problem_names(*folder);
  if (!contains(names, text))
    throw InputError("--problem " + text + ": neither a directory nor a problem that is shipped" +
                     suggestion(text, {names.begin(), names.end()}, "by `bentaxis problems`"));
  return study::read_problem(*folder / text);
}

int score(const ScoreOptions& options) {
  const study::Problem problem = problem_of(options.problem);
  const study::Score result = study::score(problem, read_table(options.file), options.tolerance);
  std::fputs(
      (options.json ? score_json(problem, result, options.file) : score_text(problem, result))
          .c_str(),
      stdout);
  if (!options.badge.empty()) write_whole(options.badge, score_badge(problem, result));
  return result.verdict == study::Score::Verdict::solved ? kDone : kOutOfTolerance;
}

}  // namespace

Command add_score_command(CommandParser program) {
  auto options = std::make_shared<ScoreOptions>();
  auto command = program.subcommand(
      "score",
      "Score a table of reactions that any program computed: digits of each column against a "
      "problem of the problem set, and which known mistake a wrong column is");
  command.option("file", options->file, Values("FILE").required(),
                 "table of the results: CSV, Excel, MATLAB or ADAMS");
  std::vector<std::string> names;
  if (const auto folder = shipped_problems()) names = study::problem_names(*folder);
  command.option("--problem", options->problem, Values("NAME|DIR").required().completed_with(names),
                 "problem that the table solves: the name of a shipped one, or its folder");
  command.option("--tolerance", options->tolerance, Values::positive(),
                 "largest difference over a reaction's peak that counts as agreement; default: the "
                 "problem's");
  command.flag("--json", options->json, "print JSON instead of text");
  command.option("--badge", options->badge, "FILE",
                 "write a badge with the digits, an SVG picture");
  return {command, [options] { return score(*options); }};
}

}  // namespace bentaxis::cli

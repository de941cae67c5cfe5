#include "score_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bentaxis/pump/lists.h"

namespace bentaxis::cli {
namespace {

using State = study::ColumnScore::State;
using Verdict = study::Score::Verdict;

const char* word(State state) {
  return state == State::agrees ? "agrees" : state == State::differs ? "differs" : "missing";
}
const char* word(Verdict verdict) {
  return verdict == Verdict::solved ? "solved" : verdict == Verdict::wrong ? "wrong" : "incomplete";
}

// Digits are not rounded up, and 0 has no sign.
double tenths(double digits) { return std::floor(digits * 10) / 10 + 0.0; }

// Decades between the spread that 2 ulp of the inputs make and the tolerance.
double margin(const study::ProblemColumn& column, double tolerance) {
  return column.spread > 0 ? std::log10(tolerance / column.spread) : 16;
}

std::string names(const study::Problem& problem, const std::vector<std::size_t>& columns) {
  return joined(columns, ", ", [&](std::size_t c) { return problem.columns[c].name; });
}

std::string mistake_text(const study::Problem& problem, const study::NamedMistake& mistake) {
  std::string text = fmt::format("{}: {}", names(problem, mistake.columns), mistake.says);
  for (const std::string& other : mistake.or_else) text += "; or: " + other;
  text += fmt::format(" (within {:.1e} of the peak)", mistake.distance);
  if (!mistake.untouched.empty())
    text +=
        fmt::format("; but {} would change too, and {} right", names(problem, mistake.untouched),
                    mistake.untouched.size() > 1 ? "are" : "is");
  return text;
}

std::string verdict_text(const study::Problem& problem, const study::Score& score) {
  const auto count = std::count_if(score.columns.begin(), score.columns.end(),
                                   [](const auto& one) { return one.state == State::agrees; });
  return fmt::format(
      "{}: {} of {} columns within {:.1e} of the peak, at {} of {} angles; {:.1f} digits",
      word(score.verdict), count, score.columns.size(), score.tolerance, score.covered,
      problem.grid.size(), tenths(score.digits()));
}

}  // namespace

std::string score_text(const study::Problem& problem, const study::Score& score) {
  std::size_t width = 6;
  for (const auto& column : problem.columns) width = std::max(width, column.name.size());
  std::string text =
      fmt::format("{}: {}\n{}\n", problem.name, problem.title, verdict_text(problem, score));
  for (const auto& mistake : score.mistakes)
    text += "mistake: " + mistake_text(problem, mistake) + "\n";
  if (!score.unexplained.empty())
    text += "no known mistake: " + names(problem, score.unexplained) + "\n";
  text += fmt::format("\n{:<{}}  {:>6}  {:>10}  {:>10}  {:>9}  {:>9}  {}\n", "column", width,
                      "digits", "difference", "at", "tolerance", "2 ulp", "result");
  for (const auto& one : score.columns) {
    const auto& column = problem.columns[one.column];
    if (one.rows == 0) {
      text += fmt::format("{:<{}}  {:>6}  {:>10}  {:>10}  {:>9.1e}  {:>9.1e}  missing\n",
                          column.name, width, "", "", "", score.tolerance, column.spread);
      continue;
    }
    text += fmt::format("{:<{}}  {:>6.1f}  {:>10.1e}  {:>10.6g}  {:>9.1e}  {:>9.1e}  {}\n",
                        column.name, width, tenths(one.digits), one.largest / column.peak, one.at,
                        score.tolerance, column.spread, word(one.state));
  }
  text += fmt::format(
      "Differences, tolerance and 2 ulp (what changes of every input by 2 ulp make) are shares of "
      "the "
      "peak; at: {}\n",
      problem.over);
  for (const std::string& gap : score.gaps) text += "gap: " + gap + "\n";
  return text;
}

std::string score_json(const study::Problem& problem, const study::Score& score,
                       const std::string& file) {
  nlohmann::ordered_json json = {{"kind", "bentaxis-score"},
                                 {"schema", 1},
                                 {"problem", problem.name},
                                 {"title", problem.title},
                                 {"file", file},
                                 {"verdict", word(score.verdict)},
                                 {"digits", tenths(score.digits())},
                                 {"tolerance", score.tolerance},
                                 {"angles", problem.grid.size()},
                                 {"angles_covered", score.covered},
                                 {"columns", nlohmann::ordered_json::array()},
                                 {"mistakes", nlohmann::ordered_json::array()},
                                 {"unexplained", nlohmann::ordered_json::array()},
                                 {"gaps", score.gaps}};
  for (const auto& one : score.columns) {
    const auto& column = problem.columns[one.column];
    nlohmann::ordered_json entry = {{"name", column.name},
                                    {"result", word(one.state)},
                                    {"peak", column.peak},
                                    {"spread_2ulp", column.spread},
                                    {"margin_decades", tenths(margin(column, score.tolerance))},
                                    {"digits_of_curve", column.digits},
                                    {"rows", one.rows}};
    if (one.rows > 0) {
      entry["digits"] = tenths(one.digits);
      entry["difference"] = one.largest / column.peak;
      entry["interpolation"] = one.interpolation;
      entry["at"] = one.at;
      entry["value"] = one.theirs;
      entry["right"] = one.right;
    }
    json["columns"].push_back(entry);
  }
  const auto list = [&](const std::vector<std::size_t>& columns) {
    auto array = nlohmann::ordered_json::array();
    for (const std::size_t c : columns) array.push_back(problem.columns[c].name);
    return array;
  };
  for (const auto& mistake : score.mistakes)
    json["mistakes"].push_back({{"says", mistake.says},
                                {"or", mistake.or_else},
                                {"columns", list(mistake.columns)},
                                {"right_though_it_would_change", list(mistake.untouched)},
                                {"distance", mistake.distance}});
  json["unexplained"] = list(score.unexplained);
  return json.dump(2) + "\n";
}

std::string score_badge(const study::Problem& problem, const study::Score& score) {
  const std::string left = "bentaxis " + problem.name;
  const std::string right =
      score.verdict == Verdict::solved
          ? fmt::format("{:.1f} digits", tenths(score.digits()))
          : fmt::format("{}, {:.1f} digits", word(score.verdict), tenths(score.digits()));
  const char* colour = score.verdict == Verdict::solved  ? "#00734d"
                       : score.verdict == Verdict::wrong ? "#a33b00"
                                                         : "#67727e";
  constexpr double kLetter = 6.6, kMargin = 7;  // px
  const double first = kLetter * static_cast<double>(left.size()) + 2 * kMargin;
  const double second = kLetter * static_cast<double>(right.size()) + 2 * kMargin;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"20\" role=\"img\" "
      "aria-label=\"{1}: {2}\">\n"
      "<title>{1}: {2}</title>\n"
      "<rect width=\"{3:.0f}\" height=\"20\" fill=\"#33414e\"/>\n"
      "<rect x=\"{3:.0f}\" width=\"{4:.0f}\" height=\"20\" fill=\"{5}\"/>\n"
      "<g fill=\"#fff\" font-family=\"DejaVu Sans,Verdana,sans-serif\" font-size=\"11\" "
      "text-anchor=\"middle\">\n"
      "<text x=\"{6:.0f}\" y=\"14\">{1}</text>\n<text x=\"{7:.0f}\" "
      "y=\"14\">{2}</text>\n</g>\n</svg>\n",
      first + second, left, right, first, second, colour, first / 2, first + second / 2);
}

std::string problems_text(const std::vector<study::Problem>& problems) {
  std::size_t width = 0;
  for (const auto& one : problems) width = std::max(width, one.name.size());
  std::string text;
  for (const auto& one : problems)
    text +=
        fmt::format("{:<{}}  {} ({} columns)\n", one.name, width, one.title, one.columns.size());
  return text;
}

std::string problems_json(const std::vector<study::Problem>& problems) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& one : problems) {
    auto columns = nlohmann::ordered_json::array();
    for (const auto& column : one.columns) columns.push_back(column.name);
    list.push_back({{"name", one.name},
                    {"title", one.title},
                    {"folder", one.folder.string()},
                    {"over", one.over},
                    {"columns", columns}});
  }
  return list.dump(2) + "\n";
}

}  // namespace bentaxis::cli

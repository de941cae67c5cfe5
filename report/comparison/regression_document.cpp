#include "bentaxis/study/regression_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/lists.h"
#include "bentaxis/study/comparison_answers.h"
#include "bentaxis/study/reference_curves.h"

namespace bentaxis::study {

using compare::Finding;
using compare::ReferenceChannel;

namespace {

// A page with more figures than this is not read.
constexpr std::size_t kMaxFigures = 40;
constexpr std::size_t kMaxCurves = 6;  // in one figure

const std::string& property(const Outcome& outcome, const std::string& name) {
  static const std::string none = "not said";
  for (const auto& [key, value] : outcome.properties)
    if (key == name) return value;
  return none;
}

// Failing channels, worst first; where all agree, those of the worst one's piston.
std::vector<std::string> shown_channels(const GroupLine& line) {
  std::vector<const ReferenceChannel*> chosen;
  for (const auto& channel : line.channels)
    if (line.failed > 0
            ? channel.finding == Finding::differs
            : channel.finding == Finding::agrees &&
                  channel.comparison.channel.piston == line.worst()->comparison.channel.piston)
      chosen.push_back(&channel);
  if (line.failed > 0)
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const auto* a, const auto* b) { return severity(*a) > severity(*b); });
  std::vector<std::string> names;
  for (const auto* channel : chosen)
    if (names.size() < kMaxCurves) names.push_back(channel->comparison.channel.name);
  return names;
}

// The reference over what was held to it: both models, or the one, with their difference.
report::Curves curves_of(const Outcome& outcome, const std::string& model,
                         const std::vector<std::string>& channels) {
  std::vector<ResultTable> results;
  const std::vector<double>& theta = outcome.held.at(model).result.theta_deg;
  for (const auto& [name, held] : outcome.held)
    if (held.result.theta_deg == theta)
      results.push_back(select_channels(
          held.result, [&](const Channel& channel) { return contains(channels, channel.name); }));
  report::Curves curves = report::curves_of(results.front(), results.back());
  if (results.size() == 1) {
    curves.tables.resize(1);
    curves.difference.clear();
  }
  curves.reference = reference_curves(outcome, channels, theta);
  return curves;
}

// What fails, and every external curve, whatever it came to: worst first.
std::vector<report::Figure> held_figures(const std::vector<Outcome>& outcomes) {
  std::vector<report::Figure> figures;
  for (const auto* line : sorted_lines(outcomes)) {
    const Outcome& outcome = *std::find_if(outcomes.begin(), outcomes.end(), [&](const Outcome& o) {
      return o.name == line->reference;
    });
    const bool wanted = line->failed > 0 || line->kind == "external";
    if (!wanted || line != outcome.worst_line(line->group) || figures.size() >= kMaxFigures)
      continue;
    const std::vector<std::string> channels = shown_channels(*line);
    if (channels.empty()) continue;
    figures.push_back({fmt::format("{}-{}", line->failed > 0 ? "fail" : "held", figures.size() + 1),
                       fmt::format("{}: {}", line->reference, line->group), "",
                       report::ChannelFigure{line->worst()->comparison.channel.unit,
                                             channels,
                                             {},
                                             curves_of(outcome, line->model, channels)},
                       fmt::format("{}. Source: {}. How made: {}.", line_text(*line),
                                   property(outcome, "source"), property(outcome, "how_made"))});
  }
  return figures;
}

report::Section notes_section(const std::vector<Outcome>& outcomes) {
  report::Section section{"Missing curves and notes", "", {}, {{"note"}, {}}};
  for (const auto& line : missing_lines(outcomes)) section.table.rows.push_back({line});
  for (const auto& outcome : outcomes)
    for (const auto& note : outcome.notes)
      section.table.rows.push_back({outcome.name + ": " + note});
  return section;
}

}  // namespace

report::Section source_section(const Outcome& outcome) {
  report::Section section{
      fmt::format("{} ({})", outcome.name, outcome.kind), held_text(outcome), {}, {}};
  for (auto [name, value] : outcome.properties) {
    std::replace(name.begin(), name.end(), '_', ' ');
    section.facts.emplace_back(name, value);
  }
  for (const auto& note : outcome.notes) section.facts.emplace_back("note", note);
  return section;
}

std::optional<report::Section> explanation_section(const std::vector<Outcome>& outcomes) {
  report::Section section{
      "What would explain the difference",
      "Parameters of the case, each changed alone or two together, until the analytic results are "
      "nearest to the reference, or left out as a whole (friction, weight, mass of the pistons); "
      "computed again with them. Share: of the sum of squared "
      "differences, each over the peak of its reaction.",
      {},
      {{"case", "parameter", "in the case", "nearest", "unit", "share", "rest of peak", "rest in",
        "explains", "not to be told apart"},
       {}}};
  bool any = false;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.explanation) continue;
    any = true;
    const Explanation& found = *outcome.explanation;
    section.facts.emplace_back(outcome.name, found.text());
    for (const auto* list : {&found.left_out, &found.singles, &found.pairs})
      for (const ExplainingChange& change : *list)
        for (const auto& p : change.parameters)
          section.table.rows.push_back(
              {outcome.name, p.name, p.from, p.to, p.unit, change.share, change.rest_over_peak,
               change.rest_channel, &change == found.cause() ? "yes" : "no", joined(p.look_same)});
  }
  if (!any) return std::nullopt;
  return section;
}

report::Table lines_table(const std::vector<Outcome>& outcomes) {
  report::Table table;
  table.columns = {"case",    "kind",    "model",  "group",    "verdict", "peak",
                   "of peak", "allowed", "digits", "compared", "missing", "worst channel"};
  for (const auto* line : sorted_lines(outcomes)) {
    const auto& c = line->worst()->comparison;
    const bool number = line->worst()->finding != Finding::incomplete;
    const auto if_known = [](bool known, double value) {
      return known ? report::Cell(value) : report::Cell();
    };
    table.rows.push_back(
        {line->reference, line->kind, line->model, line->group, line->verdict(),
         fmt::format("{:.5g} {}", c.peak, c.channel.unit), if_known(number, c.largest_over_peak()),
         if_known(c.peak > 0, c.allowed / c.peak), if_known(number, std::round(10 * c.digits) / 10),
         static_cast<long>(line->compared), static_cast<long>(line->missing), line->text()});
  }
  return table;
}

report::TestSuite suite_of(const Outcome& outcome) {
  report::TestSuite suite;
  suite.name = outcome.name;
  suite.seconds = outcome.seconds;
  suite.properties = outcome.properties;
  suite.properties.insert(suite.properties.begin(), {"kind", outcome.kind});
  for (const auto& line : outcome.lines) {
    report::TestCase test;
    test.name = line.group;
    test.class_name = outcome.name + "." + line.model;
    test.seconds = line.seconds;
    if (line.is_missing()) {
      test.outcome = report::TestOutcome::skipped;
      test.message = "the reference has no curve of this group";
    } else {
      const auto& c = line.worst()->comparison;
      const std::string figures = fmt::format(
          "peak {:.6g} {}, largest difference {:.3g} {} ({:.2e} of peak, {:.1f} digits), "
          "allowed {:.3g} {}; {} channels compared, {} missing",
          c.peak, c.channel.unit, c.largest, c.channel.unit, c.largest_over_peak(), c.digits,
          c.allowed, c.channel.unit, line.compared, line.missing);
      test.details = figures;
      if (line.failed > 0) {
        test.outcome = report::TestOutcome::failed;
        test.message = line.text();
        for (const auto& channel : line.channels)
          if (channel.failed())
            test.details += fmt::format("\n{}: {}, {:.3g} {} at {:g} deg; {}",
                                        channel.comparison.channel.name, to_string(channel.finding),
                                        channel.comparison.largest, channel.comparison.channel.unit,
                                        channel.comparison.theta_of_largest_deg, channel.hint);
      }
    }
    suite.cases.push_back(std::move(test));
  }
  if (!outcome.error.empty() || outcome.lines.empty()) {
    report::TestCase test;
    test.name = outcome.error.empty() ? "read" : "case";
    test.class_name = outcome.name;
    test.seconds = outcome.seconds;
    if (!outcome.error.empty()) {
      test.outcome = outcome.state == Outcome::State::differs ? report::TestOutcome::failed
                                                              : report::TestOutcome::error;
      test.message = outcome.error;
    }
    suite.cases.push_back(std::move(test));
  }
  return suite;
}

report::Document regression_document(const std::vector<Outcome>& outcomes, const std::string& what,
                                     const report::Lines& program) {
  const bool agrees = std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) {
    return outcome.state == Outcome::State::agrees;
  });
  report::Document document;
  document.title = "Regression of " + what;
  document.program = program;
  document.verdict = report::Verdict{agrees, summary(outcomes)};
  document.verdict->answers = regression_answers(outcomes);
  document.meaning =
      "High-precision curves verify: they were computed independently. Golden curves detect "
      "changes of the program. External curves are another tool's or a rig's. A missing curve is "
      "not compared.";
  document.warnings.emplace();
  for (const auto& outcome : outcomes)
    if (!outcome.error.empty()) document.warnings->push_back({outcome.name, outcome.error});
  document.runs = {{"Every case and group of channels, worst first",
                    "Of peak: largest difference over the reaction's peak in the reference; where "
                    "angles are rounded or a curve is resampled, that nearest to its limit.",
                    {},
                    lines_table(outcomes)}};
  if (auto section = explanation_section(outcomes)) document.runs->push_back(std::move(*section));
  if (auto notes = notes_section(outcomes); !notes.table.rows.empty())
    document.runs->push_back(std::move(notes));
  for (const auto& outcome : outcomes)
    if (outcome.kind == "external" && !outcome.held.empty())
      document.runs->push_back(source_section(outcome));
  document.figures = held_figures(outcomes);
  return document;
}

}  // namespace bentaxis::study

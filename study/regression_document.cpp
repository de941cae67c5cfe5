#include "bentaxis/study/regression_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bentaxis::study {

using compare::Finding;
using compare::ReferenceChannel;

namespace {

// A page with more figures than this is not read.
constexpr std::size_t kMostFigures = 40;
constexpr std::size_t kMostCurves = 6;  // in one figure

// A table with some of its columns.
ResultTable columns_of(const ResultTable& table, const std::vector<std::string>& names) {
  ResultTable out;
  out.name = table.name;
  out.theta_deg = table.theta_deg;
  for (const auto& name : names) out.channels.push_back(table.channels[table.find(name)]);
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const auto& name : names) out.values.push_back(table.at(row, table.find(name)));
  return out;
}

std::vector<report::Figure> failing_figures(const std::vector<Outcome>& outcomes) {
  std::vector<report::Figure> figures;
  for (const auto* line : sorted_lines(outcomes)) {
    if (line->failed == 0 || figures.size() >= kMostFigures) continue;
    const auto outcome = std::find_if(outcomes.begin(), outcomes.end(),
                                      [&](const Outcome& o) { return o.name == line->reference; });
    const auto& [reference, result] = outcome->tables.at(line->model);
    std::vector<const ReferenceChannel*> worst;
    for (const auto& channel : line->channels)
      if (channel.finding == Finding::differs) worst.push_back(&channel);
    std::stable_sort(worst.begin(), worst.end(),
                     [](const auto* a, const auto* b) { return severity(*a) > severity(*b); });
    std::vector<std::string> channels;
    for (const auto* channel : worst)
      if (channels.size() < kMostCurves) channels.push_back(channel->comparison.channel.name);
    if (channels.empty()) continue;
    figures.push_back({fmt::format("fail-{}", figures.size() + 1),
                       fmt::format("{}, {}: {}", line->reference, line->group, line->model), "",
                       report::ChannelFigure{line->worst()->comparison.channel.unit,
                                             channels,
                                             {},
                                             report::curves_of(columns_of(reference, channels),
                                                               columns_of(result, channels))},
                       line->text()});
  }
  return figures;
}

report::Section lines_section(const std::vector<Outcome>& outcomes) {
  report::Section section;
  section.title = "Every case and group of channels, worst first";
  section.text = "Of peak: largest difference over the reaction's peak in the reference.";
  section.table.columns = {"case",    "kind",    "model",  "group",    "verdict", "peak",
                           "of peak", "allowed", "digits", "compared", "missing", "worst channel"};
  for (const auto* line : sorted_lines(outcomes)) {
    const auto& c = line->worst()->comparison;
    const bool number = line->worst()->finding != Finding::incomplete;
    const auto if_known = [](bool known, double value) {
      return known ? report::Cell(value) : report::Cell();
    };
    section.table.rows.push_back(
        {line->reference, line->kind, line->model, line->group, line->verdict(),
         fmt::format("{:.5g} {}", c.peak, c.channel.unit), if_known(number, c.largest_over_peak()),
         if_known(c.peak > 0, c.allowed / c.peak), if_known(number, std::round(10 * c.digits) / 10),
         static_cast<long>(line->compared), static_cast<long>(line->missing), line->text()});
  }
  return section;
}

report::Section notes_section(const std::vector<Outcome>& outcomes) {
  report::Section section;
  section.title = "Missing curves and notes";
  section.table.columns = {"note"};
  for (const auto& line : missing_lines(outcomes)) section.table.rows.push_back({line});
  for (const auto& outcome : outcomes)
    for (const auto& note : outcome.notes)
      section.table.rows.push_back({outcome.name + ": " + note});
  return section;
}

}  // namespace

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
  document.meaning =
      "High-precision curves verify: they were computed independently. Golden curves detect "
      "changes of the program. External curves are another tool's or a rig's. A missing curve is "
      "neither agreement nor disagreement.";
  document.warnings.emplace();
  for (const auto& outcome : outcomes)
    if (!outcome.error.empty()) document.warnings->push_back({outcome.name, outcome.error});
  document.runs = {lines_section(outcomes)};
  if (auto notes = notes_section(outcomes); !notes.table.rows.empty())
    document.runs->push_back(std::move(notes));
  document.figures = failing_figures(outcomes);
  return document;
}

}  // namespace bentaxis::study

#include "bentaxis/study/regression_document.h"

#include "bentaxis/study/comparison_answers.h"
#include "bentaxis/study/reference_curves.h"
#include "document_parts.h"

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
    std::ranges::stable_sort(
        chosen, [](const auto* a, const auto* b) { return severity(*a) > severity(*b); });
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
    const Outcome& outcome = *std::ranges::find_if(
        outcomes, [&](const Outcome& o) { return o.name == line->reference; });
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
  report::NewSection section("Missing curves and notes");
  section.columns("note");
  for (const auto& line : missing_lines(outcomes)) section.row(line);
  for (const auto& outcome : outcomes)
    for (const auto& note : outcome.notes) section.row(outcome.name + ": " + note);
  return section;
}

// One group of channels of one model as a test.
report::TestCase test_of(const Outcome& outcome, const GroupLine& line) {
  report::TestCase test{line.group, outcome.name + "." + line.model, line.seconds};
  if (line.is_missing()) {
    test.outcome = report::TestOutcome::skipped;
    test.message = "the reference has no curve of this group";
    return test;
  }
  const auto& c = line.worst()->comparison;
  test.details = fmt::format(
      "peak {:.6g} {}, largest difference {:.3g} {} ({:.2e} of peak, {:.1f} digits), "
      "allowed {:.3g} {}; {} channels compared, {} missing",
      c.peak, c.channel.unit, c.largest, c.channel.unit, c.largest_over_peak(), c.digits, c.allowed,
      c.channel.unit, line.compared, line.missing);
  if (line.failed == 0) return test;
  test.outcome = report::TestOutcome::failed;
  test.message = line.text();
  for (const auto& channel : line.channels)
    if (channel.failed())
      test.details += fmt::format("\n{}: {}, {:.3g} {} at {:g} deg; {}",
                                  channel.comparison.channel.name, to_string(channel.finding),
                                  channel.comparison.largest, channel.comparison.channel.unit,
                                  channel.comparison.theta_of_largest_deg, channel.hint);
  return test;
}

}  // namespace

report::Section source_section(const Outcome& outcome) {
  report::NewSection section(fmt::format("{} ({})", outcome.name, outcome.kind),
                             held_text(outcome));
  for (const auto& [name, value] : outcome.properties)
    section.fact(replace_all(name, "_", " "), value);
  for (const auto& note : outcome.notes) section.fact("note", note);
  return section;
}

std::optional<report::Section> explanation_section(const std::vector<Outcome>& outcomes) {
  report::NewSection section(
      "What would explain the difference",
      "Parameters of the case, each changed alone or two together, until the analytic results are "
      "nearest to the reference, or left out as a whole (friction, weight, mass of the pistons); "
      "computed again with them. Share: of the sum of squared differences, each over the peak of "
      "its reaction.");
  section.columns("case", "parameter", "in the case", "nearest", "unit", "share", "rest of peak",
                  "rest in", "explains", "not to be told apart");
  for (const Outcome& outcome : outcomes) {
    if (!outcome.explanation) continue;
    const Explanation& found = *outcome.explanation;
    section.fact(outcome.name, found.text());
    for (const auto* list : {&found.left_out, &found.singles, &found.pairs})
      for (const ExplainingChange& change : *list)
        for (const auto& p : change.parameters)
          section.row(outcome.name, p.name, p.from, p.to, p.unit, change.share,
                      change.rest_over_peak, change.rest_channel,
                      &change == found.cause() ? "yes" : "no", joined(p.look_same));
  }
  if (section.facts.empty()) return std::nullopt;
  return section;
}

report::Table lines_table(const std::vector<Outcome>& outcomes) {
  report::NewSection lines("");
  lines.columns("case", "kind", "model", "group", "verdict", "peak", "of peak", "allowed", "digits",
                "compared", "missing", "worst channel");
  for (const auto* line : sorted_lines(outcomes)) {
    const auto& c = line->worst()->comparison;
    const bool complete = line->worst()->finding != Finding::incomplete;
    const auto if_known = [](bool known, double value) { return known ? value : not_computed(); };
    lines.row(line->reference, line->kind, line->model, line->group, line->verdict(),
              fmt::format("{:.5g} {}", c.peak, c.channel.unit),
              if_known(complete, c.largest_over_peak()), if_known(c.peak > 0, c.allowed / c.peak),
              if_known(complete, std::round(10 * c.digits) / 10), line->compared, line->missing,
              line->text());
  }
  return lines.table;
}

report::TestSuite suite_of(const Outcome& outcome) {
  report::TestSuite suite{outcome.name, outcome.seconds, outcome.properties, {}};
  suite.properties.insert(suite.properties.begin(), {"kind", outcome.kind});
  for (const auto& line : outcome.lines) suite.cases.push_back(test_of(outcome, line));
  if (!outcome.error.empty())
    suite.cases.push_back({"case", outcome.name, outcome.seconds,
                           outcome.state == Outcome::State::differs ? report::TestOutcome::failed
                                                                    : report::TestOutcome::error,
                           outcome.error, ""});
  else if (outcome.lines.empty())
    suite.cases.push_back({"read", outcome.name, outcome.seconds});
  return suite;
}

report::Document regression_document(const std::vector<Outcome>& outcomes, const std::string& what,
                                     const report::Lines& program) {
  report::Document document;
  document.title = "Regression of " + what;
  document.program = program;
  document.verdict = {
      .agrees = std::ranges::all_of(
          outcomes, [](const Outcome& outcome) { return outcome.state == Outcome::State::agrees; }),
      .headline = summary(outcomes),
      .answers = regression_answers(outcomes)};
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

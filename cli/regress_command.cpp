#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "bentaxis/compare/published.h"
#include "bentaxis/compare/reference.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/report/junit.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/report.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "reference_set.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;
using compare::Finding;
using compare::ReferenceChannel;
using report::Json;

// A page with more figures than this is not read.
constexpr std::size_t kMostFigures = 40;
constexpr std::size_t kMostCurves = 6;  // in one figure

struct Options {
  std::string folder, junit, html, filter;
};

// Difference over what is allowed; -1 where nothing was compared.
double severity(const ReferenceChannel& channel) {
  if (channel.finding == Finding::incomplete) return 1e300;
  if (channel.finding != Finding::agrees && channel.finding != Finding::differs) return -1;
  const auto& c = channel.comparison;
  return c.allowed > 0 ? c.largest / c.allowed : c.largest > 0 ? 1e300 : 0;
}

// One group of channels of one model, held against one reference.
struct GroupLine {
  std::string reference, kind, model, group;
  std::vector<ReferenceChannel> channels;
  int compared = 0, missing = 0, failed = 0;
  double seconds = 0;

  // The channel nearest to failing or furthest beyond; null where nothing was compared.
  const ReferenceChannel* worst() const;
  bool is_missing() const { return compared == 0 && failed == 0; }
  std::string verdict() const {
    return failed > 0 ? to_string(worst()->finding) : is_missing() ? "missing" : "agrees";
  }
};

const ReferenceChannel* GroupLine::worst() const {
  const auto it =
      std::max_element(channels.begin(), channels.end(),
                       [](const auto& a, const auto& b) { return severity(a) < severity(b); });
  return it == channels.end() || severity(*it) < 0 ? nullptr : &*it;
}

// What one reference came to.
struct Outcome {
  std::string name, kind, error;
  int status = kDone;
  double seconds = 0;
  std::vector<GroupLine> lines;
  std::vector<std::string> notes;
  std::vector<std::pair<std::string, std::string>> properties;
  // For the figures: by model.
  std::map<std::string, std::pair<ResultTable, ResultTable>> tables;  // reference, result
};

std::vector<GroupLine> group_lines(const compare::Judgement& judgement) {
  std::map<std::string, GroupLine> groups;
  for (const auto& channel : judgement.channels) {
    if (channel.finding == Finding::absent) continue;
    groups[channel.comparison.channel.group].channels.push_back(channel);
  }
  std::vector<GroupLine> lines;
  for (auto& [group, line] : groups) {
    line.group = group;
    lines.push_back(std::move(line));
  }
  for (auto& line : lines)
    for (const auto& channel : line.channels) {
      line.compared += channel.finding == Finding::agrees || channel.finding == Finding::differs;
      line.missing += channel.finding == Finding::missing;
      line.failed += channel.failed();
    }
  return lines;
}

void hold_to_curves(const compare::ReferenceDescription& description, Outcome& outcome) {
  const ReferenceCases cases = cases_of(description);
  std::vector<fs::path> used;
  for (const Case* the_case : {&cases.analytic, &cases.multibody})
    for (const auto& file : files_of(*the_case)) used.push_back(file);
  compare::check_files(description, used);
  outcome.properties = {{"source", description.source},
                        {"how_made", description.how_made},
                        {"digits", std::to_string(description.digits)},
                        {"tolerance, relative to peak", fmt::format("{:g}", description.relative)},
                        {"tube, deg", fmt::format("{:g}", description.tube_deg)}};
  bool any = false;
  for (const std::string model : {"analytic", "multibody"}) {
    const auto start = std::chrono::steady_clock::now();
    const auto holds = [&](const auto& curve) {
      return std::find(curve.models.begin(), curve.models.end(), model) != curve.models.end();
    };
    if (std::none_of(description.curves.begin(), description.curves.end(), holds)) continue;
    const Case& the_case = model == "analytic" ? cases.analytic : cases.multibody;
    const ChannelLayout layout(the_case.pump.geometry.pistons);
    std::vector<compare::ReferenceCurve> curves;
    for (const auto& curve : description.curves)
      if (holds(curve))
        curves.push_back(compare::read_reference_curve(description, curve, layout.channels(),
                                                       6 * the_case.operation.speed_rpm));
    ReferenceRun run = run_for_reference(model, the_case);
    compare::Judgement judgement = compare::judge(description, curves, run.table, run.zero_scales);
    if (judgement.resampled)
      outcome.notes.push_back(fmt::format(
          "{}: the reference has other angles than the case and was resampled, which adds an error "
          "of about {:.1e} of peak",
          model, judgement.resampling_error));
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    auto lines = group_lines(judgement);
    for (auto& line : lines) {
      line.reference = description.name;
      line.kind = outcome.kind;
      line.model = model;
      line.seconds = seconds / static_cast<double>(lines.size());
      any = any || line.compared > 0;
      if (line.failed > 0) outcome.status = kOutOfTolerance;
      outcome.lines.push_back(std::move(line));
    }
    outcome.tables[model] = {std::move(judgement.reference), std::move(run.table)};
  }
  if (!any) {
    outcome.status = std::max(outcome.status, static_cast<int>(kOutOfTolerance));
    outcome.error = "nothing was compared: no column of the reference stands for a result";
  }
}

Outcome hold(const ReferencePlace& place) {
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome;
  outcome.name = place.name;
  outcome.kind = "unknown";
  try {
    const auto description = compare::read_description(place.folder, place.name);
    outcome.kind = compare::to_string(description.kind);
    if (description.kind == compare::ReferenceKind::published) {
      compare::check_files(description, {});
      const auto published = compare::read_published(description.numbers);
      outcome.notes.push_back(fmt::format(
          "{} printed numbers and windows read; they are judged in the report of compare",
          published.numbers.size()));
    } else {
      hold_to_curves(description, outcome);
    }
  } catch (const InputError& error) {
    outcome.status = kBadInput;
    outcome.error = error.what();
  } catch (const ComputationError& error) {
    outcome.status = kComputationFailed;
    outcome.error = error.what();
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

std::string describe(const GroupLine& line) {
  if (line.worst() == nullptr) return "";
  const auto& c = line.worst()->comparison;
  if (line.worst()->finding == Finding::incomplete)
    return c.channel.name + ": " + line.worst()->hint;
  std::string text = fmt::format("{} at {:g} deg", c.channel.name, c.theta_of_largest_deg);
  if (line.failed > 1) text += fmt::format(" and {} more", line.failed - 1);
  if (!line.worst()->hint.empty()) text += ": " + line.worst()->hint;
  return text;
}

std::vector<const GroupLine*> sorted_lines(const std::vector<Outcome>& outcomes) {
  std::vector<const GroupLine*> lines;
  for (const auto& outcome : outcomes)
    for (const auto& line : outcome.lines)
      if (!line.is_missing()) lines.push_back(&line);
  std::stable_sort(lines.begin(), lines.end(), [](const auto* a, const auto* b) {
    return severity(*a->worst()) > severity(*b->worst());
  });
  return lines;
}

// Both models' lines of one case and group are one line of the listing.
struct ListingLine {
  const GroupLine* worse = nullptr;
  std::map<std::string, const GroupLine*> by_model;
};

std::vector<ListingLine> listing(const std::vector<Outcome>& outcomes) {
  std::vector<ListingLine> list;
  std::map<std::pair<std::string, std::string>, std::size_t> index;
  for (const auto* line : sorted_lines(outcomes)) {
    const auto [it, added] = index.emplace(std::pair(line->reference, line->group), list.size());
    if (added) list.push_back({line, {}});
    list[it->second].by_model[line->model] = line;
  }
  return list;
}

std::string figure_of(const GroupLine* line) {
  if (line == nullptr) return "-";
  if (line->worst() == nullptr || line->worst()->finding == Finding::incomplete)
    return "incomplete";
  const auto& c = line->worst()->comparison;
  return fmt::format("{:.1e} {:4.1f}", c.largest_over_peak(), c.digits);
}

// Groups without any curve in the reference, by reference.
std::vector<std::string> missing_lines(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> lines;
  for (const auto& outcome : outcomes) {
    std::map<std::string, std::string> groups;  // groups to models
    for (const auto& line : outcome.lines)
      if (line.is_missing())
        groups[line.group] += (groups[line.group].empty() ? "" : ", ") + line.model;
    std::map<std::string, std::string> by_models;
    for (const auto& [group, models] : groups)
      by_models[models] += (by_models[models].empty() ? "" : ", ") + group;
    for (const auto& [models, names] : by_models)
      lines.push_back(
          fmt::format("missing     {}: no curve of {} ({})", outcome.name, names, models));
  }
  return lines;
}

void print(const std::vector<Outcome>& outcomes) {
  const auto lines = listing(outcomes);
  std::size_t width = 10;
  for (const auto& line : lines) width = std::max(width, line.worse->reference.size());
  if (!lines.empty())
    std::printf("%s", fmt::format("{:<11} {:<{}} {:<6} {:>10} {:<2}  {:<12} {:<12} {:>8}  {}\n",
                                  "verdict", "case", width, "group", "peak", "", "analytic",
                                  "multibody", "allowed", "worst channel")
                          .c_str());
  for (const auto& line : lines) {
    const auto of = [&](const char* model) {
      const auto it = line.by_model.find(model);
      return figure_of(it == line.by_model.end() ? nullptr : it->second);
    };
    const GroupLine& worse = *line.worse;
    const auto& c = worse.worst()->comparison;
    std::string more = describe(worse);
    if (worse.missing > 0)
      more += fmt::format(" ({} of {} channels missing)", worse.missing, worse.channels.size());
    std::printf("%s",
                fmt::format("{:<11} {:<{}} {:<6} {:>10.4g} {:<2}  {:<12} {:<12} {:>8.1e}  {}\n",
                            worse.verdict(), worse.reference, width, worse.group, c.peak,
                            c.channel.unit, of("analytic"), of("multibody"),
                            c.peak > 0 ? c.allowed / c.peak : c.allowed, more)
                    .c_str());
  }
  for (const auto& line : missing_lines(outcomes)) std::printf("%s\n", line.c_str());
  for (const auto& outcome : outcomes)
    for (const auto& note : outcome.notes)
      std::printf("note        %s: %s\n", outcome.name.c_str(), note.c_str());
}

std::string summary(const std::vector<Outcome>& outcomes) {
  int agree = 0, differ = 0, unusable = 0, failed = 0, published = 0;
  std::size_t groups = 0;
  for (const auto& outcome : outcomes) {
    groups += static_cast<std::size_t>(
        std::count_if(outcome.lines.begin(), outcome.lines.end(),
                      [](const auto& line) { return !line.is_missing(); }));
    if (outcome.status == kBadInput)
      ++unusable;
    else if (outcome.status == kComputationFailed)
      ++failed;
    else if (outcome.status == kOutOfTolerance)
      ++differ;
    else if (outcome.kind == "published")
      ++published;
    else
      ++agree;
  }
  std::string text = fmt::format("{} agree, {} differ", agree, differ);
  if (unusable > 0) text += fmt::format(", {} cannot be used", unusable);
  if (failed > 0) text += fmt::format(", {} could not be computed", failed);
  text += fmt::format("; {} groups of channels compared", groups);
  if (published > 0) text += "; published numbers were read and are judged by compare";
  return text + ".";
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
        test.message = describe(line);
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
      test.outcome = outcome.status == kOutOfTolerance ? report::TestOutcome::failed
                                                       : report::TestOutcome::error;
      test.message = outcome.error;
    }
    suite.cases.push_back(std::move(test));
  }
  return suite;
}

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

Json figures_of(const std::vector<Outcome>& outcomes) {
  Json figures = Json::array();
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
    figures.push_back(
        {{"id", fmt::format("fail-{}", figures.size() + 1)},
         {"title", fmt::format("{}, {}: {}", line->reference, line->group, line->model)},
         {"paper", ""},
         {"unit", line->worst()->comparison.channel.unit},
         {"channels", channels},
         {"note", describe(*line)},
         {"curves",
          report::curve_section(columns_of(reference, channels), columns_of(result, channels))}});
  }
  return figures;
}

std::string page(const std::vector<Outcome>& outcomes, const fs::path& root, int status) {
  Json rows = Json::array();
  for (const auto* line : sorted_lines(outcomes)) {
    const auto& c = line->worst()->comparison;
    const bool number = line->worst()->finding != Finding::incomplete;
    rows.push_back({line->reference, line->kind, line->model, line->group, line->verdict(),
                    fmt::format("{:.5g} {}", c.peak, c.channel.unit),
                    number ? Json(c.largest_over_peak()) : Json(),
                    c.peak > 0 ? Json(c.allowed / c.peak) : Json(),
                    number ? Json(std::round(10 * c.digits) / 10) : Json(), line->compared,
                    line->missing, describe(*line)});
  }
  Json runs = Json::array();
  Json problems = Json::array();
  for (const auto& outcome : outcomes) {
    if (!outcome.error.empty())
      problems.push_back({{"name", outcome.name}, {"text", outcome.error}});
  }
  Json notes = Json::array();
  for (const auto& line : missing_lines(outcomes)) notes.push_back({line});
  for (const auto& outcome : outcomes)
    for (const auto& note : outcome.notes) notes.push_back({outcome.name + ": " + note});
  runs.push_back(
      {{"title", "Every case and group of channels, worst first"},
       {"text", "Of peak: largest difference over the reaction's peak in the reference."},
       {"table",
        {{"columns",
          {"case", "kind", "model", "group", "verdict", "peak", "of peak", "allowed", "digits",
           "compared", "missing", "worst channel"}},
         {"rows", rows}}}});
  if (!notes.empty())
    runs.push_back({{"title", "Missing curves and notes"},
                    {"table", {{"columns", {"note"}}, {"rows", notes}}}});
  const Json report = {
      {"schema", 1},
      {"title", "Regression of " + root.filename().string()},
      {"program", versions()},
      {"verdict", {{"agrees", status == kDone}, {"headline", summary(outcomes)}}},
      {"meaning",
       "High-precision curves verify: they were computed independently. Golden curves detect "
       "changes of the program. External curves are another tool's or a rig's. A missing curve is "
       "neither agreement nor disagreement."},
      {"warnings", problems},
      {"runs", runs},
      {"figures", figures_of(outcomes)}};
  return report::render_page("Regression", report, Json::object());
}

void write(const std::string& file, const std::string& content) {
  const fs::path path = fs::absolute(file);
  OutputFolder folder(path.parent_path());
  folder.add(path.filename(), content);
  folder.commit();
}

int regress(const Options& options) {
  const auto shipped = shipped_reference_data();
  if (options.folder.empty() && !shipped)
    throw InputError("no reference data are installed with this program: name a folder");
  const fs::path root = options.folder.empty() ? *shipped : fs::path(options.folder);
  std::vector<ReferencePlace> places = references_below(root);
  const std::size_t all = places.size();
  std::erase_if(places, [&](const auto& place) {
    return place.name.find(options.filter) == std::string::npos;
  });
  if (places.empty())
    throw InputError(fmt::format("--filter \"{}\" leaves none of the {} cases below {}",
                                 options.filter, all, root.string()));
  std::vector<Outcome> outcomes;
  int status = kDone;
  for (const auto& place : places) {
    outcomes.push_back(hold(place));
    const Outcome& outcome = outcomes.back();
    status = std::max(status, outcome.status);
    if (!outcome.error.empty())
      std::fprintf(stderr, "bentaxis: %s: %s\n", outcome.name.c_str(), outcome.error.c_str());
  }
  print(outcomes);
  std::printf("%s\n", summary(outcomes).c_str());
  if (!options.junit.empty()) {
    std::vector<report::TestSuite> suites;
    for (const auto& outcome : outcomes) suites.push_back(suite_of(outcome));
    write(options.junit, report::junit_xml("bentaxis regress", suites));
  }
  if (!options.html.empty())
    write(options.html, page(outcomes, fs::absolute(root / ".").parent_path(), status));
  return status;
}

}  // namespace

Command add_regress_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "regress", "Hold both models to stored curves: the shipped reference data or your own");
  command->add_option("dir", options->folder, "folder with references (default: the shipped set)")
      ->option_text("[DIR]");
  command->add_option("--junit", options->junit, "write the results as JUnit XML")
      ->option_text("FILE");
  command->add_option("--html", options->html, "write a page with the curves that fail")
      ->option_text("FILE");
  command->add_option("--filter", options->filter, "only cases whose name contains this text")
      ->option_text("TEXT");
  return {command, [options] { return regress(*options); }};
}

}  // namespace bentaxis::cli

#include "bentaxis/study/regression.h"

#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/compare/published.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/achieved_error.h"

namespace bentaxis::study {

using compare::Finding;
using compare::ReferenceChannel;

namespace {

std::vector<GroupLine> group_lines(const compare::Judgement& judgement) {
  std::map<std::string, GroupLine> groups;
  for (const auto& channel : judgement.channels) {
    if (channel.finding == Finding::absent) continue;
    GroupLine& line = groups[channel.comparison.channel.group];
    line.group = channel.comparison.channel.group;
    line.compared += channel.finding == Finding::agrees || channel.finding == Finding::differs;
    line.missing += channel.finding == Finding::missing;
    line.failed += channel.failed();
    line.channels.push_back(channel);
  }
  std::vector<GroupLine> lines;
  for (auto& [group, line] : groups) lines.push_back(std::move(line));
  return lines;
}

// A reference at fewer angles than the results is judged at its own, as `regress` does: every
// stride-th row is one of them.
std::size_t stride_of(const compare::ReferenceDescription& description, const Case& the_case) {
  const int all = the_case.operation.samples_per_revolution;
  const int theirs = description.samples_per_revolution.value_or(all);
  return all % theirs == 0 ? static_cast<std::size_t>(all / theirs) : 1;
}

// What is to be known of the angles that were compared, said once where it is so of both models.
void note_angles(const std::string& model, const compare::Judgement& judgement,
                 std::vector<std::string>& notes) {
  if (judgement.resampled)
    notes.push_back(fmt::format(
        "{}: the reference has other angles than the results and was resampled, which adds an "
        "error of up to {:.1e} of peak; this is added to the tolerance around each angle",
        model, judgement.resampling_error));
  if (judgement.at_own_angles)
    add_once(notes, fmt::format("the models are computed at the reference's own {} angles",
                                judgement.reference.rows()));
  for (const auto& gap : judgement.gaps)
    add_once(notes, fmt::format("nothing is compared between {:g} and {:g} deg, where the "
                                "reference has no points",
                                gap.from_deg, gap.to_deg));
}

// A model that is held to a reference.
struct HeldModel {
  std::vector<double> theta_deg;  // of the case's samples
  compare::ZeroScales zero_scales;
  compare::ResultAt at;               // no function where it cannot be run at any angles:
  const ResultTable* only = nullptr;  // then these results
};

// Holds both models to the curves; nothing is run here but by `model_of`.
void hold_to_curves(const compare::ReferenceDescription& description, const CaseOf& case_of,
                    const std::function<HeldModel(Model)>& model_of, Outcome& outcome) {
  outcome.properties = {{"source", description.source},
                        {"how_made", description.how_made},
                        {"digits", std::to_string(description.digits)},
                        {"tolerance, relative to peak", fmt::format("{:g}", description.relative)},
                        {"tube, deg", fmt::format("{:g}", description.tube_deg)}};
  for (const auto& curve : description.curves)
    for (const auto& line : compare::assumptions_of(curve)) {
      outcome.notes.push_back(line);
      outcome.properties.emplace_back("assumption", line);
    }
  bool any = false;
  for (const Model which : kModels) {
    const std::string model = to_string(which);
    const Stopwatch stopwatch;
    const auto holds = [&](const auto& curve) { return contains(curve.models, model); };
    if (std::none_of(description.curves.begin(), description.curves.end(), holds)) continue;
    const Case& the_case = case_of(which);
    const ChannelLayout layout(the_case.pump);
    std::vector<compare::ReferenceCurve> curves;
    for (const auto& curve : description.curves)
      if (holds(curve))
        curves.push_back(compare::read_reference_curve(description, curve, layout.channels(),
                                                       6 * the_case.operation.speed_rpm,
                                                       frames_of(the_case)));
    for (const auto& curve : curves)
      for (const auto& note : curve.notes) outcome.notes.push_back(model + ": " + note);
    const HeldModel held = model_of(which);
    compare::Judgement judgement;
    if (held.at) {
      judgement = compare::judge(description, curves, held.at, held.theta_deg, held.zero_scales);
    } else {
      ResultTable result = every_row(*held.only, stride_of(description, the_case));
      judgement = compare::judge(description, curves, result, held.zero_scales);
      judgement.result = std::move(result);
    }
    note_angles(model, judgement, outcome.notes);
    const double seconds = stopwatch.seconds();
    auto lines = group_lines(judgement);
    for (auto& line : lines) {
      line.reference = description.name;
      line.kind = outcome.kind;
      line.model = model;
      line.seconds = seconds / static_cast<double>(lines.size());
      any = any || line.compared > 0;
      if (line.failed > 0) outcome.state = Outcome::State::differs;
      outcome.lines.push_back(std::move(line));
    }
    outcome.held[model] = {std::move(judgement.result),     std::move(judgement.reference),
                           std::move(judgement.low),        std::move(judgement.high),
                           std::move(judgement.resampling), std::move(judgement.gaps)};
  }
  if (!any) {
    outcome.state = std::max(outcome.state, Outcome::State::differs);
    outcome.error = "nothing was compared: no column of the reference is a result";
  }
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

}  // namespace

double severity(const ReferenceChannel& channel) {
  if (channel.finding == Finding::incomplete) return 1e300;
  if (channel.finding != Finding::agrees && channel.finding != Finding::differs) return -1;
  const auto& c = channel.comparison;
  return c.allowed > 0 ? c.largest / c.allowed : c.largest > 0 ? 1e300 : 0;
}

const ReferenceChannel* GroupLine::worst() const {
  const auto it =
      std::max_element(channels.begin(), channels.end(),
                       [](const auto& a, const auto& b) { return severity(a) < severity(b); });
  return it == channels.end() || severity(*it) < 0 ? nullptr : &*it;
}

bool GroupLine::differs() const {
  return std::any_of(channels.begin(), channels.end(), [](const ReferenceChannel& channel) {
    return channel.finding == Finding::differs;
  });
}

std::string GroupLine::verdict() const {
  return failed > 0 ? to_string(worst()->finding) : is_missing() ? "missing" : "agrees";
}

std::string GroupLine::text() const {
  const ReferenceChannel* channel = worst();
  if (channel == nullptr) return "";
  const auto& c = channel->comparison;
  if (channel->finding == Finding::incomplete) return c.channel.name + ": " + channel->hint;
  std::string words = fmt::format("{} at {:g} deg", c.channel.name, c.theta_of_largest_deg);
  if (failed > 1) words += fmt::format(" and {} more", failed - 1);
  if (!channel->hint.empty()) words += ": " + channel->hint;
  return words;
}

Outcome hold(const ReferencePlace& place, const PartProgress& progress_of) {
  const Stopwatch stopwatch;
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
          "{} printed numbers and windows read; they are compared in the report of compare",
          published.numbers.size()));
    } else {
      const ReferenceCases cases(description, progress_of);
      std::vector<std::filesystem::path> used;
      for (const Model model : kModels)
        for (const auto& file : files_of(cases.of(model).the_case)) used.push_back(file);
      compare::check_files(description, used);
      hold_to_curves(
          description, [&](Model model) -> const Case& { return cases.of(model).the_case; },
          [&](Model model) {
            const PreparedCase& ready = cases.of(model);
            const Samples samples = ready.samples(Way::driven);
            return HeldModel{samples.theta_deg, zero_scales(ready.the_case, samples),
                             [&ready, model, &progress_of](const std::vector<double>& theta_deg) {
                               return run_at_angles(ready, theta_deg, {.model = model},
                                                    progress_of);
                             }};
          },
          outcome);
    }
  } catch (const InputError& error) {
    outcome.state = Outcome::State::unusable;
    outcome.error = error.what();
  } catch (const ComputationError& error) {
    outcome.state = Outcome::State::failed;
    outcome.error = error.what();
  }
  outcome.seconds = stopwatch.seconds();
  return outcome;
}

compare::ReferenceDescription reference_in(const std::filesystem::path& folder) {
  const auto places = references_below(folder);
  if (places.size() != 1)
    throw InputError(fmt::format("{}: contains {} references; name the directory of one",
                                 folder.string(), places.size()));
  auto description = compare::read_description(places[0].folder, places[0].name);
  if (description.kind == compare::ReferenceKind::published)
    throw InputError(folder.string() + ": contains printed numbers but no curves");
  return description;
}

Outcome hold_results(const std::filesystem::path& folder, const CaseOf& case_of,
                     const ResultOf& result_of, const ResultAt& result_at) {
  const Stopwatch stopwatch;
  const auto description = reference_in(folder);
  const Case theirs = read_case(description.case_file);
  std::vector<std::filesystem::path> used = files_of(theirs);
  if (description.multibody_case_file != description.case_file)
    for (const auto& file : files_of(read_case(description.multibody_case_file)))
      used.push_back(file);
  compare::check_files(description, used);
  Outcome outcome;
  outcome.name = description.name;
  outcome.kind = compare::to_string(description.kind);
  std::map<Model, ReferenceRun> runs;
  hold_to_curves(
      description, case_of,
      [&](Model model) {
        const ReferenceRun& run = runs[model] = result_of(model);
        HeldModel held{run.table.theta_deg, run.zero_scales, {}, &run.table};
        if (result_at)
          held.at = [&run, &result_at, model](const std::vector<double>& theta_deg) {
            if (auto there = compare::rows_at(run.table, theta_deg)) return std::move(*there);
            return result_at(model, theta_deg);
          };
        return held;
      },
      outcome);
  outcome.other_case = differing_keys(theirs, case_of(Model::analytic));
  if (!outcome.other_case.empty())
    outcome.notes.push_back("was made for another case: " + outcome.other_case);
  outcome.seconds = stopwatch.seconds();
  return outcome;
}

bool Outcome::differs() const {
  return state == State::differs &&
         std::any_of(lines.begin(), lines.end(),
                     [](const GroupLine& line) { return line.differs(); });
}

const ReferenceChannel* Outcome::find(const std::string& model, const std::string& channel) const {
  for (const GroupLine& line : lines)
    for (const ReferenceChannel& entry : line.channels)
      if (line.model == model && entry.comparison.channel.name == channel && severity(entry) >= 0)
        return &entry;
  return nullptr;
}

const GroupLine* Outcome::worst_line(const std::string& group) const {
  const GroupLine* worst = nullptr;
  for (const GroupLine& line : lines)
    if (line.group == group && line.worst() != nullptr &&
        (worst == nullptr || severity(*line.worst()) > severity(*worst->worst())))
      worst = &line;
  return worst;
}

std::string line_text(const GroupLine& line) {
  const auto& c = line.worst()->comparison;
  if (line.worst()->finding == Finding::incomplete)
    return fmt::format("{} {} ({}): {}", line.group, line.verdict(), line.model, line.text());
  return fmt::format("{} {}: {:.2g} % of peak ({:.3g} {}), {:.2g} % allowed; {} ({})", line.group,
                     line.verdict(), 100 * c.largest_over_peak(), c.largest, c.channel.unit,
                     100 * (c.peak > 0 ? c.allowed / c.peak : 0), line.text(), line.model);
}

namespace {

// "Td_z1_Nm (the reference does not have it)": what could not be compared, and why.
std::string not_compared_text(const Outcome& outcome) {
  constexpr std::size_t kMostNamed = 6;
  std::vector<std::string> reasons;
  std::map<std::string, std::vector<std::string>> channels;  // by reason
  for (const GroupLine& line : outcome.lines)
    for (const ReferenceChannel& channel : line.channels) {
      if (channel.finding != Finding::incomplete) continue;
      add_once(reasons, channel.hint);
      add_once(channels[channel.hint], channel.comparison.channel.name);
    }
  return joined(reasons, "; ", [&](const std::string& reason) {
    std::vector<std::string> names = channels[reason];
    const std::size_t more = names.size() > kMostNamed ? names.size() - kMostNamed : 0;
    names.resize(names.size() - more);
    return joined(names) + (more > 0 ? fmt::format(" and {} more", more) : "") + " (" + reason +
           ")";
  });
}

}  // namespace

std::string held_text(const Outcome& outcome) {
  if (!outcome.error.empty()) return outcome.error;
  std::vector<std::string> groups, differing;
  const GroupLine* worst = nullptr;
  for (const GroupLine& line : outcome.lines) {
    if (line.compared == 0) continue;
    add_once(groups, line.group);
    if (line.differs()) add_once(differing, line.group);
    if (line.worst()->finding != Finding::incomplete &&
        (worst == nullptr || severity(*line.worst()) > severity(*worst->worst())))
      worst = &line;
  }
  std::string text =
      differing.empty()
          ? fmt::format("{0} of {0} reactions compared agree.", groups.size())
          : fmt::format("{} of {} reactions compared differ.", differing.size(), groups.size());
  if (worst != nullptr) text += " Worst: " + line_text(*worst) + ".";
  if (const std::string rest = not_compared_text(outcome); !rest.empty())
    text += " Not compared: " + rest + ".";
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

// Groups without any curve in the reference, by reference.
std::vector<std::string> missing_lines(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> lines;
  for (const auto& outcome : outcomes) {
    std::map<std::string, std::vector<std::string>> models_of, by_models;  // by group
    for (const auto& line : outcome.lines)
      if (line.is_missing()) models_of[line.group].push_back(line.model);
    for (const auto& [group, models] : models_of) by_models[joined(models)].push_back(group);
    for (const auto& [models, groups] : by_models)
      lines.push_back(
          fmt::format("missing     {}: no curve of {} ({})", outcome.name, joined(groups), models));
  }
  return lines;
}

std::string regression_text(const std::vector<Outcome>& outcomes) {
  std::string text;
  const auto lines = listing(outcomes);
  std::size_t width = 10;
  for (const auto& line : lines) width = std::max(width, line.worse->reference.size());
  if (!lines.empty())
    text += fmt::format("{:<11} {:<{}} {:<6} {:>10} {:<2}  {:<12} {:<12} {:>8}  {}\n", "verdict",
                        "case", width, "group", "peak", "", "analytic", "multibody", "allowed",
                        "worst channel");
  for (const auto& line : lines) {
    const auto of = [&](const char* model) {
      const auto it = line.by_model.find(model);
      return figure_of(it == line.by_model.end() ? nullptr : it->second);
    };
    const GroupLine& worse = *line.worse;
    const auto& c = worse.worst()->comparison;
    std::string more = worse.text();
    if (worse.missing > 0)
      more += fmt::format(" ({} of {} channels missing)", worse.missing, worse.channels.size());
    text += fmt::format("{:<11} {:<{}} {:<6} {:>10.4g} {:<2}  {:<12} {:<12} {:>8.1e}  {}\n",
                        worse.verdict(), worse.reference, width, worse.group, c.peak,
                        c.channel.unit, of("analytic"), of("multibody"),
                        c.peak > 0 ? c.allowed / c.peak : c.allowed, more);
  }
  for (const auto& line : missing_lines(outcomes)) text += line + "\n";
  for (const auto& outcome : outcomes)
    for (const auto& note : outcome.notes)
      text += fmt::format("note        {}: {}\n", outcome.name, note);
  return text;
}

std::string summary(const std::vector<Outcome>& outcomes) {
  int agree = 0, differ = 0, incomplete = 0, unusable = 0, failed = 0, published = 0;
  std::size_t groups = 0;
  for (const auto& outcome : outcomes) {
    groups +=
        static_cast<std::size_t>(std::count_if(outcome.lines.begin(), outcome.lines.end(),
                                               [](const auto& line) { return line.compared > 0; }));
    if (outcome.state == Outcome::State::unusable)
      ++unusable;
    else if (outcome.state == Outcome::State::failed)
      ++failed;
    else if (outcome.differs())
      ++differ;
    else if (outcome.state == Outcome::State::differs)
      ++incomplete;
    else if (outcome.kind == "published")
      ++published;
    else
      ++agree;
  }
  std::string text = fmt::format("{} agree, {} differ", agree, differ);
  if (incomplete > 0) text += fmt::format(", {} incomplete", incomplete);
  if (unusable > 0) text += fmt::format(", {} cannot be used", unusable);
  if (failed > 0) text += fmt::format(", {} could not be computed", failed);
  text += fmt::format("; {} groups of channels compared", groups);
  if (published > 0) text += "; published numbers were read and are compared by compare";
  return text + ".";
}

}  // namespace bentaxis::study

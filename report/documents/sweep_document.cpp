#include "bentaxis/designs/sweep_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bentaxis/designs/independence.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "document_parts.h"
#include "sweep_sections.h"
#include "sweep_view.h"

namespace bentaxis::designs {

using report::Cell;
using report::Section;

namespace {

constexpr std::size_t kAllRows = 60;  // designs of a sweep that is printed whole
constexpr std::size_t kBestRows = 20;
constexpr std::size_t kMaxReasons = 30, kMaxDiffering = 40;

std::string percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? "0 %"
                    : fmt::format("{:.3g} %",
                                  100 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string other_model(const SweepResult& result) {
  return result.plan.model == study::Model::analytic ? "Simbody" : "the closed form";
}

std::string values_text(const Varied& varied) {
  const Variable& variable = varied.variable;
  const auto& levels = varied.levels;
  if (levels.empty()) return varied.distribution.text();
  if (levels.size() > 8)
    return fmt::format("{} .. {}, {} values", value_text(variable, levels.front()),
                       value_text(variable, levels.back()), levels.size());
  return joined(levels, ", ", [&](double level) { return value_text(variable, level); });
}

}  // namespace

Section plan_section(const SweepResult& result, const SweepView& view) {
  const SweepPlan& plan = result.plan;
  Section section{
      "What was varied", "", {}, {{"parameter", "meaning", "values", "in the case"}, {}}};
  section.facts = {{"designs", fmt::format("{}", plan.size())},
                   {"sampling", to_string(plan.sampling)}};
  if (plan.sampling != Sampling::grid)
    section.facts.emplace_back("seed", fmt::format("{}", plan.seed));
  section.facts.emplace_back("model", study::to_string(plan.model));
  if (result.every > 1)
    section.text = fmt::format(
        "Figures and tables below are of every {}th design, {} of {}; the result files have all.",
        result.every, view.designs(), plan.size());
  for (const Varied& varied : plan.varied) {
    const Variable& variable = varied.variable;
    const std::string unit = variable.unit().empty() ? "" : " (" + variable.unit() + ")";
    section.table.rows.push_back({variable.name(), variable.meaning() + unit, values_text(varied),
                                  value_text(variable, variable.value(result.base))});
  }
  return section;
}

Section outputs_section(const SweepView& view) {
  Section section{
      "Outputs",
      "",
      {},
      {{"output", "unit", "meaning", "sought", "lowest", "of design", "highest", "of design"}, {}}};
  for (std::size_t k = 0; k < view.outputs(); ++k) {
    std::size_t lowest = view.designs(), highest = view.designs();
    for (std::size_t i = 0; i < view.designs(); ++i) {
      const double v = view.result(i, k);
      if (!is_computed(v)) continue;
      if (lowest == view.designs() || v < view.result(lowest, k)) lowest = i;
      if (highest == view.designs() || v > view.result(highest, k)) highest = i;
    }
    const Output& output = view.output(k);
    const int direction = view.direction(k);
    std::vector<Cell> row = {output.name, output.unit, output.meaning,
                             direction < 0   ? "smallest"
                             : direction > 0 ? "largest"
                                             : ""};
    for (const std::size_t design : {lowest, highest}) {
      const bool found = design < view.designs();
      row.emplace_back(found ? view.result(design, k) : not_computed());
      row.emplace_back(found ? fmt::format("{}: {}", view.number(design), view.text(design)) : "");
    }
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

namespace {

// Reasons that differ in their numbers only are one.
std::string kind_of(const std::string& reason) {
  std::string kind;
  for (const char c : reason) {
    const bool of_number = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
    if (!of_number)
      kind += c;
    else if (kind.empty() || kind.back() != '#')
      kind += '#';
  }
  return kind;
}

}  // namespace

Section infeasible_section(const SweepResult& result, const SweepView& view) {
  struct Group {
    std::size_t designs = 0, first = 0;
    std::string example;
  };
  std::map<std::string, Group> groups;
  for (const auto& [design, reason] : result.infeasible) {
    Group& group = groups[kind_of(reason)];
    if (group.designs++ > 0) continue;
    group.first = design;
    group.example = reason;
  }
  std::vector<Group> sorted;
  for (const auto& [kind, group] : groups) sorted.push_back(group);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Group& a, const Group& b) { return a.designs > b.designs; });
  Section section{
      "Infeasible designs",
      "Reasons why a case file with these values is refused or cannot be computed. Reasons that "
      "differ in numbers only are counted together; the first is shown.",
      {{"infeasible", fmt::format("{} of {} designs, {}", result.all_infeasible, result.plan.size(),
                                  percent(result.all_infeasible, result.plan.size()))}},
      {{"reason", "designs", "first design"}, {}}};
  if (sorted.size() > kMaxReasons) {
    section.text +=
        fmt::format(" The {} most frequent of {} are shown.", kMaxReasons, sorted.size());
    sorted.resize(kMaxReasons);
  }
  for (const Group& group : sorted)
    section.table.rows.push_back(
        {group.example, static_cast<long>(group.designs),
         fmt::format("{}: {}", view.number(group.first), view.text(group.first))});
  return section;
}

namespace {

// Name and unit of an axis.
std::string heading(const report::Axis& axis) {
  return axis.unit.empty() ? axis.label : axis.label + ", " + axis.unit;
}

}  // namespace

// Rows of designs: their values and results.
void put_designs(const SweepView& view, const std::vector<std::size_t>& designs,
                 report::Table& table) {
  table.columns = {"design"};
  for (std::size_t k = 0; k < view.variables(); ++k) table.columns.push_back(heading(view.axis(k)));
  for (std::size_t k = 0; k < view.outputs(); ++k)
    table.columns.push_back(heading(view.output_axis(k)));
  for (const std::size_t design : designs) {
    std::vector<Cell> row = {static_cast<long>(view.number(design))};
    for (std::size_t k = 0; k < view.variables(); ++k) {
      const double value = view.value(design, k);
      if (view.variable(k).words().empty())
        row.emplace_back(value);
      else
        row.emplace_back(view.variable(k).text(value));
    }
    for (std::size_t k = 0; k < view.outputs(); ++k) row.emplace_back(view.result(design, k));
    table.rows.push_back(std::move(row));
  }
}

namespace {

std::vector<std::size_t> by_output(const SweepView& view, std::vector<std::size_t> designs,
                                   std::size_t output) {
  const double sign = view.direction(output);
  std::erase_if(designs, [&](std::size_t d) { return !is_computed(view.result(d, output)); });
  std::stable_sort(designs.begin(), designs.end(), [&](std::size_t a, std::size_t b) {
    return sign * view.result(a, output) > sign * view.result(b, output);
  });
  return designs;
}

}  // namespace

// The front, or where one output alone is sought the best by it.
Section best_section(const SweepView& view) {
  std::size_t output = 0;
  while (view.direction(output) == 0) ++output;
  Section section;
  std::vector<std::size_t> designs;
  if (view.sought() == 1) {
    designs = by_output(view, thinned(view.designs(), view.designs() + 1), output);
    section.title = "Best designs";
    section.text = "By " + view.output(output).name + ".";
    designs.resize(std::min(designs.size(), kBestRows));
  } else {
    const auto& front = view.front();
    section.title = "Pareto front";
    section.text =
        "Pareto front: designs that no other design equals in all outputs sought and exceeds in "
        "one.";
    section.facts = {{"on the front", fmt::format("{} designs", front.size())}};
    for (const std::size_t i : thinned(front.size(), kBestRows)) designs.push_back(front[i]);
    if (designs.size() < front.size())
      section.text += fmt::format(" {} of them, evenly chosen, are shown.", designs.size());
    designs = by_output(view, std::move(designs), output);
  }
  put_designs(view, designs, section.table);
  return section;
}

namespace {

Section checks_section(const SweepResult& result) {
  Section section{
      "Recomputed by " + other_model(result),
      "Designs chosen by a hash of their numbers. A difference is over the scale of its output, "
      "the peak of the curve over the turn. A design that both models refuse is not compared.",
      {{"agree", fmt::format("{} of {}", result.agreeing(), result.compared())},
       {"not compared",
        fmt::format("{} of {}", result.checks.size() - result.compared(), result.checks.size())},
       {"tolerance", fmt::format("{:g} of the scale", result.tolerance)}},
      {{"output", "designs compared", "largest difference over its scale", "of design"}, {}}};
  for (const std::string& output : not_independent(result.plan.outputs, result.base))
    section.facts.emplace_back("not checked", output);
  for (std::size_t k = 0; k < result.plan.outputs.size(); ++k) {
    long compared = 0;
    compare::Difference largest;
    std::size_t where = 0;
    for (const SweepCheck& check : result.checks) {
      if (k >= check.scales.size() || check.scales[k] == 0) continue;
      ++compared;
      if (largest.keep_larger(check.difference(k))) where = check.design;
    }
    section.table.rows.push_back({result.plan.outputs[k].name, compared, largest.share(),
                                  compared > 0 ? Cell(static_cast<long>(where)) : Cell()});
  }
  return section;
}

Section differing_section(const SweepResult& result) {
  Section section{"Designs in which the models differ",
                  "",
                  {},
                  {{"design", "output", study::to_string(result.plan.model), other_model(result),
                    "difference over its scale"},
                   {}}};
  std::size_t all = 0;
  const auto add = [&](std::vector<Cell> row) {
    if (++all <= kMaxDiffering) section.table.rows.push_back(std::move(row));
  };
  for (const SweepCheck& check : result.checks) {
    if (!check.compared() || check.agrees(result.tolerance)) continue;
    const long design = static_cast<long>(check.design);
    if (check.own_reason.empty() != check.reason.empty()) {
      add({design, "", check.own_reason.empty() ? "feasible" : check.own_reason,
           check.reason.empty() ? "feasible" : check.reason, Cell()});
      continue;
    }
    for (std::size_t k = 0; k < check.scales.size(); ++k)
      if (!(check.error(k) <= result.tolerance))
        add({design, result.plan.outputs[k].name, check.own[k], check.values[k], check.error(k)});
  }
  if (all > kMaxDiffering) section.text = fmt::format("The first {} of {}.", kMaxDiffering, all);
  return section;
}

}  // namespace

namespace {

struct ValidityCounts {
  std::size_t wrong = 0, unknown = 0;
};

ValidityCounts counts_of(const std::vector<DesignValidity>& designs) {
  ValidityCounts counts;
  for (const DesignValidity& v : designs) {
    counts.wrong += !v.limits.empty();
    counts.unknown += !v.reason.empty();
  }
  return counts;
}

}  // namespace

std::string validity_text(const std::vector<DesignValidity>& designs, const std::string& which) {
  const ValidityCounts counts = counts_of(designs);
  const auto of_all = [&](std::size_t count) {
    return designs.size() == 1 ? fmt::format("the {} design is", which)
                               : fmt::format("{} of {} {} designs {}", count, designs.size(), which,
                                             count == 1 ? "is" : "are");
  };
  std::string text;
  if (counts.wrong > 0) text = of_all(counts.wrong) + " not valid over the whole turn";
  if (counts.unknown > 0)
    text += (text.empty() ? "" : ", ") + of_all(counts.unknown) + " not checked for validity";
  return text.empty() ? of_all(designs.size()) + " valid over the whole turn" : text;
}

std::string not_valid_designs(const std::vector<DesignValidity>& designs,
                              const std::string& which) {
  const std::size_t wrong = counts_of(designs).wrong;
  return wrong == 0 ? "" : fmt::format("for {} of {} {} designs", wrong, designs.size(), which);
}

void append_limits(std::vector<std::string>& answers, const std::vector<DesignValidity>& designs,
                   const std::string& option, std::size_t every) {
  std::vector<std::string> keys;
  for (const DesignValidity& v : designs)
    for (const std::string& key : v.keys) add_once(keys, key);
  if (keys.empty()) return;
  const bool constrains = option == "--subject-to";
  const std::string text = joined(keys, ", ", [&](const std::string& key) {
    const std::string share = "validity." + key + ".share";
    return option + (constrains ? " \"" + share + " <= 0\"" : " " + share);
  });
  // What does not hold, of the design that is worst.
  const auto worst = std::max_element(
      designs.begin(), designs.end(),
      [](const DesignValidity& a, const DesignValidity& b) { return a.share < b.share; });
  for (const std::string& limit : worst->limits)
    answers.push_back(fmt::format("Design {}: {}", worst->design * every, limit));
  answers.push_back((constrains ? "To have valid designs only: " : "To see it for every design: ") +
                    text + ".");
}

std::string headline(const SweepResult& result) {
  std::string text = fmt::format("{} design{} in {} parameter{}", result.plan.size(),
                                 result.plan.size() == 1 ? "" : "s", result.plan.varied.size(),
                                 result.plan.varied.size() == 1 ? "" : "s");
  text += result.all_infeasible == 0 ? ", all feasible"
                                     : fmt::format(", {} infeasible", result.all_infeasible);
  const std::size_t compared = result.compared(), refused = result.checks.size() - compared;
  if (compared > 0)
    text += fmt::format("; {} agrees at {} of {} designs", other_model(result), result.agreeing(),
                        compared);
  if (refused > 0)
    text += fmt::format(
        "; {} of {} checked designs not compared: both models refuse them or give no value",
        refused, result.checks.size());
  if (!result.best.empty()) text += "; " + validity_text(result.best, "best");
  return text;
}

namespace {

// Of a value of an output, for the answers.
std::string printed(double value) { return fmt::format("{:.5g}", value); }

// "; not valid over 7.5 % of the turn" of a best design.
std::string validity_suffix(const SweepResult& result, std::optional<std::size_t> design) {
  for (const DesignValidity& v : result.best)
    if (v.design == design && !v.valid()) return "; " + v.text();
  return "";
}

}  // namespace

std::vector<std::string> sweep_answers(const SweepResult& result) {
  const SweepView view(result);
  std::vector<std::string> answers;
  const auto design_text = [&](std::size_t d) {
    return fmt::format("design {}, {}", view.number(d), view.text(d));
  };
  for (std::size_t k = 0; k < view.outputs(); ++k) {
    if (std::string constant = view.constant_text(k); !constant.empty()) {
      answers.push_back(std::move(constant));
      continue;
    }
    std::optional<std::size_t> lowest, highest;
    for (std::size_t d = 0; d < view.designs(); ++d) {
      const double value = view.result(d, k);
      if (!is_computed(value)) continue;
      if (!lowest || value < view.result(*lowest, k)) lowest = d;
      if (!highest || value > view.result(*highest, k)) highest = d;
    }
    const Output& output = view.output(k);
    if (!lowest) {
      answers.push_back(output.name + ": no design has a value.");
      continue;
    }
    const auto end = [&](const char* word, std::size_t d) {
      return fmt::format("{} {}{} ({})", word, printed(view.result(d, k)), unit_after(output.unit),
                         design_text(d));
    };
    const int direction = view.direction(k);
    if (printed(view.result(*lowest, k)) == printed(view.result(*highest, k)) &&
        lowest != highest) {
      answers.push_back(fmt::format("{} is {}{} in every design, to the digits that are printed.",
                                    output.name, printed(view.result(*lowest, k)),
                                    unit_after(output.unit)));
      continue;
    }
    answers.push_back(output.name + ": " +
                      (direction < 0   ? end("best, lowest", *lowest)
                       : direction > 0 ? end("best, highest", *highest)
                                       : end("lowest", *lowest) + "; " + end("highest", *highest)) +
                      validity_suffix(result, direction < 0   ? lowest
                                              : direction > 0 ? highest
                                                              : std::nullopt) +
                      ".");
  }
  if (view.sought() > 1)
    answers.push_back(fmt::format(
        "Trade-off: {} designs of {} are not dominated in the {} outputs sought (Pareto front).",
        view.front().size(), view.designs(), view.sought()));
  if (const auto shared = not_independent(result.plan.outputs, result.base);
      !result.checks.empty() && !shared.empty())
    answers.push_back("Not checked by the other model: " + joined(shared) + ".");
  append_limits(answers, result.best, "--output", result.every);
  if (result.every > 1)
    answers.push_back(
        fmt::format("Of every {}th design alone; the result files have all.", result.every));
  return answers;
}

report::Document sweep_document(const SweepResult& result, const report::Lines& program,
                                const study::CaseDescription& description) {
  const SweepView view(result);
  report::Document document =
      study::case_document(description, result.base.name + ": a sweep", program);
  document.verdict = report::Verdict{result.agrees(), headline(result)};
  document.verdict->answers = sweep_answers(result);
  document.verdict->not_valid = not_valid_designs(result.best, "best");
  if (result.checks.empty()) {
    document.verdict->agrees.reset();
    document.verdict->word = "Sweep";
  } else if (result.compared() == 0) {
    document.verdict->word = "Nothing compared";
  }
  document.meaning =
      result.checks.empty()
          ? "Outputs of every design by one model. Nothing was compared: --check SHARE has designs "
            "recomputed by the other."
          : "Outputs of every design by one model. Agreement of the other model at the checked "
            "designs verifies that the equations are solved correctly; it does not validate them.";
  document.runs.emplace();
  document.runs->push_back(plan_section(result, view));
  document.runs->push_back(outputs_section(view));
  if (view.sought() > 0) {
    document.runs->push_back(best_section(view));
    for (const DesignValidity& v : result.best)
      document.runs->back().facts.emplace_back(fmt::format("design {}", view.number(v.design)),
                                               v.valid() ? "valid over the whole turn" : v.text());
  }
  if (!result.infeasible.empty()) document.runs->push_back(infeasible_section(result, view));
  if (!result.checks.empty()) document.runs->push_back(checks_section(result));
  if (result.agreeing() < result.compared()) document.runs->push_back(differing_section(result));
  if (view.designs() <= kAllRows) {
    document.runs->push_back({"All designs", "", {}, {}});
    put_designs(view, thinned(view.designs(), kAllRows), document.runs->back().table);
  }
  document.figures = sweep_figures(view);
  return document;
}

}  // namespace bentaxis::designs

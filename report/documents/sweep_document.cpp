#include "bentaxis/designs/sweep_document.h"

#include <map>

#include "bentaxis/designs/independence.h"
#include "document_parts.h"
#include "sweep_sections.h"
#include "sweep_view.h"

namespace bentaxis::designs {
namespace {

using report::Cell;
using report::NewSection;
using report::Section;

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

// "12: pump.tilt_deg 40", of a design by its number in the view.
std::string named(const SweepView& view, std::size_t design) {
  return fmt::format("{}: {}", view.number(design), view.text(design));
}

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

// Name and unit of an axis.
std::string heading(const report::Axis& axis) {
  return axis.unit.empty() ? axis.label : axis.label + ", " + axis.unit;
}

// Rows of designs: their values and results.
void put_designs(const SweepView& view, const std::vector<std::size_t>& designs,
                 NewSection& section) {
  section.columns("design");
  for (std::size_t k = 0; k < view.variables(); ++k) section.columns(heading(view.axis(k)));
  for (std::size_t k = 0; k < view.outputs(); ++k) section.columns(heading(view.output_axis(k)));
  for (const std::size_t design : designs) {
    report::Row values;
    for (std::size_t k = 0; k < view.variables(); ++k) {
      const double value = view.value(design, k);
      values.push_back(view.variable(k).words().empty() ? Cell(value)
                                                        : Cell(view.variable(k).text(value)));
    }
    for (std::size_t k = 0; k < view.outputs(); ++k) values.emplace_back(view.result(design, k));
    section.row(view.number(design), values);
  }
}

std::vector<std::size_t> by_output(const SweepView& view, std::vector<std::size_t> designs,
                                   std::size_t output) {
  const double sign = view.direction(output);
  std::erase_if(designs, [&](std::size_t d) { return !is_computed(view.result(d, output)); });
  std::ranges::stable_sort(designs, [&](std::size_t a, std::size_t b) {
    return sign * view.result(a, output) > sign * view.result(b, output);
  });
  return designs;
}

Section checks_section(const SweepResult& result) {
  NewSection section(
      "Recomputed by " + other_model(result),
      "Designs chosen by a hash of their numbers. A difference is over the scale of its output, "
      "the peak of the curve over the turn. A design that both models refuse is not compared.");
  section.fact("agree", "{} of {}", result.agreeing(), result.compared());
  section.fact("not compared", "{} of {}", result.checks.size() - result.compared(),
               result.checks.size());
  section.fact("tolerance", "{:g} of the scale", result.tolerance);
  for (const std::string& output : not_independent(result.plan.outputs, result.base))
    section.fact("not checked", output);
  section.columns("output", "designs compared", "largest difference over its scale", "of design");
  for (std::size_t k = 0; k < result.plan.outputs.size(); ++k) {
    std::size_t compared = 0, where = 0;
    compare::Difference largest;
    for (const SweepCheck& check : result.checks) {
      if (k >= check.scales.size() || check.scales[k] == 0) continue;
      ++compared;
      if (largest.keep_larger(check.difference(k))) where = check.design;
    }
    section.row(result.plan.outputs[k].name, compared, largest.share(),
                compared > 0 ? std::optional(where) : std::nullopt);
  }
  return section;
}

Section differing_section(const SweepResult& result) {
  NewSection section("Designs in which the models differ");
  section.columns("design", "output", study::to_string(result.plan.model), other_model(result),
                  "difference over its scale");
  std::size_t all = 0;
  const auto add = [&](const auto&... cells) {
    if (++all <= kMaxDiffering) section.row(cells...);
  };
  const auto feasible_or = [](const std::string& reason) {
    return reason.empty() ? "feasible" : reason;
  };
  for (const SweepCheck& check : result.checks) {
    if (!check.compared() || check.agrees(result.tolerance)) continue;
    if (check.own_reason.empty() != check.reason.empty()) {
      add(check.design, "", feasible_or(check.own_reason), feasible_or(check.reason));
      continue;
    }
    for (std::size_t k = 0; k < check.scales.size(); ++k)
      if (!(check.error(k) <= result.tolerance))
        add(check.design, result.plan.outputs[k].name, check.own[k], check.values[k],
            check.error(k));
  }
  if (all > kMaxDiffering) section.text = fmt::format("The first {} of {}.", kMaxDiffering, all);
  return section;
}

struct ValidityCounts {
  std::size_t wrong = 0, unknown = 0;
};

ValidityCounts counts_of(const std::vector<DesignValidity>& designs) {
  return {report::count_of(designs, [](const auto& v) { return !v.limits.empty(); }),
          report::count_of(designs, [](const auto& v) { return !v.reason.empty(); })};
}

// Of a value of an output, for the answers.
std::string printed(double value) { return fmt::format("{:.5g}", value); }

// "; not valid over 7.5 % of the turn" of a best design.
std::string validity_suffix(const SweepResult& result, std::size_t design) {
  for (const DesignValidity& v : result.best)
    if (v.design == design && !v.valid()) return "; " + v.text();
  return "";
}

// Of one output: its best design, or the lowest and the highest.
std::string answer_of(const SweepResult& result, const SweepView& view, std::size_t k) {
  if (std::string constant = view.constant_text(k); !constant.empty()) return constant;
  const Output& output = view.output(k);
  const auto ends = view.ends(k);
  if (!ends) return output.name + ": no design has a value.";
  const auto [lowest, highest] = *ends;
  const auto value = [&](std::size_t d) {
    return printed(view.result(d, k)) + unit_after(output.unit);
  };
  if (value(lowest) == value(highest) && lowest != highest)
    return fmt::format("{} is {} in every design, to the digits that are printed.", output.name,
                       value(lowest));
  const auto end = [&](const char* word, std::size_t d) {
    return fmt::format("{} {} (design {}, {})", word, value(d), view.number(d), view.text(d));
  };
  const int direction = view.direction(k);
  if (direction == 0)
    return output.name + ": " + end("lowest", lowest) + "; " + end("highest", highest) + ".";
  const std::size_t best = direction < 0 ? lowest : highest;
  return output.name + ": " + end(direction < 0 ? "best, lowest" : "best, highest", best) +
         validity_suffix(result, best) + ".";
}

}  // namespace

Section plan_section(const SweepResult& result, const SweepView& view) {
  const SweepPlan& plan = result.plan;
  NewSection section("What was varied");
  section.columns("parameter", "meaning", "values", "in the case");
  section.fact("designs", "{}", plan.size());
  section.fact("sampling", to_string(plan.sampling));
  if (plan.sampling != Sampling::grid) section.fact("seed", "{}", plan.seed);
  section.fact("model", study::to_string(plan.model));
  if (result.every > 1)
    section.text = fmt::format(
        "Figures and tables below are of every {}th design, {} of {}; the result files have all.",
        result.every, view.designs(), plan.size());
  for (const Varied& varied : plan.varied) {
    const Variable& variable = varied.variable;
    const std::string unit = variable.unit().empty() ? "" : " (" + variable.unit() + ")";
    section.row(variable.name(), variable.meaning() + unit, values_text(varied),
                value_text(variable, variable.value(result.base)));
  }
  return section;
}

Section outputs_section(const SweepView& view) {
  NewSection section("Outputs");
  section.columns("output", "unit", "meaning", "sought", "lowest", "of design", "highest",
                  "of design");
  for (std::size_t k = 0; k < view.outputs(); ++k) {
    const Output& output = view.output(k);
    const int direction = view.direction(k);
    const char* sought = direction < 0 ? "smallest" : direction > 0 ? "largest" : "";
    report::Row found = {not_computed(), "", not_computed(), ""};
    if (const auto ends = view.ends(k))
      found = report::row_of(view.result(ends->first, k), named(view, ends->first),
                             view.result(ends->second, k), named(view, ends->second));
    section.row(output.name, output.unit, output.meaning, sought, found);
  }
  return section;
}

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
  std::ranges::stable_sort(sorted,
                           [](const Group& a, const Group& b) { return a.designs > b.designs; });
  NewSection section(
      "Infeasible designs",
      "Reasons why a case file with these values is refused or cannot be computed. Reasons that "
      "differ in numbers only are counted together; the first is shown.");
  section.fact("infeasible", "{} of {} designs, {}", result.all_infeasible, result.plan.size(),
               percent(result.all_infeasible, result.plan.size()));
  section.columns("reason", "designs", "first design");
  if (sorted.size() > kMaxReasons) {
    section.say("The {} most frequent of {} are shown.", kMaxReasons, sorted.size());
    sorted.resize(kMaxReasons);
  }
  for (const Group& group : sorted)
    section.row(group.example, group.designs, named(view, group.first));
  return section;
}

// The front, or where one output alone is sought the best by it.
Section best_section(const SweepView& view) {
  std::size_t output = 0;
  while (view.direction(output) == 0) ++output;
  if (view.sought() == 1) {
    NewSection section("Best designs", "By " + view.output(output).name + ".");
    auto designs = by_output(view, thinned(view.designs(), view.designs() + 1), output);
    designs.resize(std::min(designs.size(), kBestRows));
    put_designs(view, designs, section);
    return section;
  }
  NewSection section(
      "Pareto front",
      "Pareto front: designs that no other design equals in all outputs sought and exceeds in "
      "one.");
  const auto& front = view.front();
  section.fact("on the front", "{} designs", front.size());
  const auto designs =
      report::each_of(thinned(front.size(), kBestRows), [&](std::size_t i) { return front[i]; });
  if (designs.size() < front.size())
    section.say("{} of them, evenly chosen, are shown.", designs.size());
  put_designs(view, by_output(view, designs, output), section);
  return section;
}

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
  const auto worst = std::ranges::max_element(designs, {}, &DesignValidity::share);
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

std::vector<std::string> sweep_answers(const SweepResult& result) {
  const SweepView view(result);
  std::vector<std::string> answers;
  for (std::size_t k = 0; k < view.outputs(); ++k) answers.push_back(answer_of(result, view, k));
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
  const bool checked = !result.checks.empty();
  document.verdict = {.agrees = checked ? std::optional(result.agrees()) : std::nullopt,
                      .headline = headline(result),
                      .word = !checked                 ? "Sweep"
                              : result.compared() == 0 ? "Nothing compared"
                                                       : "",
                      .not_valid = not_valid_designs(result.best, "best"),
                      .answers = sweep_answers(result)};
  document.meaning =
      checked ? "Outputs of every design by one model. Agreement of the other model at the checked "
                "designs verifies that the equations are solved correctly; it does not validate "
                "them."
              : "Outputs of every design by one model. Nothing was compared: --check SHARE has "
                "designs recomputed by the other.";
  document.runs = {plan_section(result, view), outputs_section(view)};
  if (view.sought() > 0) {
    document.runs->push_back(best_section(view));
    for (const DesignValidity& v : result.best)
      document.runs->back().facts.emplace_back(fmt::format("design {}", view.number(v.design)),
                                               v.valid() ? "valid over the whole turn" : v.text());
  }
  if (!result.infeasible.empty()) document.runs->push_back(infeasible_section(result, view));
  if (checked) document.runs->push_back(checks_section(result));
  if (result.agreeing() < result.compared()) document.runs->push_back(differing_section(result));
  if (view.designs() <= kAllRows) {
    NewSection all("All designs");
    put_designs(view, thinned(view.designs(), kAllRows), all);
    document.runs->push_back(std::move(all));
  }
  document.figures = sweep_figures(view);
  return document;
}

}  // namespace bentaxis::designs

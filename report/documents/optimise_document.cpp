#include "bentaxis/designs/optimise_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "document_parts.h"
#include "sweep_sections.h"
#include "sweep_view.h"

namespace bentaxis::designs {
namespace {

// What is so near to its end is at it: of the range of a parameter, of the scale of a constraint.
constexpr double kAtEnd = 1e-3;

std::string with_unit(double value, const Output& output) {
  return fmt::format("{:.5g}{}", value, unit_after(output.unit));
}

double measured(const Optimisation& found, std::size_t design, std::size_t output) {
  return found.measured[design * found.plan.designs.outputs.size() + output];
}

// "70.2 N (the case: 76.7 N, -8.5 %)"
std::string against_case(const Optimisation& found, std::size_t design, std::size_t output) {
  const Output& o = found.plan.designs.outputs[output];
  const double now = measured(found, design, output), own = found.own.values[output];
  if (!is_computed(own)) return with_unit(now, o);
  const std::string change =
      own == 0 ? "" : fmt::format(", {:+.2g} %", 100 * (now - own) / std::abs(own));
  return fmt::format("{} (the case: {}{})", with_unit(now, o), with_unit(own, o), change);
}

// Constraints that a design lies on, and parameters at an end of their range.
std::vector<std::string> bindings(const Optimisation& found, std::size_t design) {
  const SweepPlan& plan = found.plan.designs;
  std::vector<std::string> all;
  for (const Constraint& c : found.plan.constraints) {
    // With conditions an objective is measured as a mean, which no condition is held to.
    const bool of_mean = plan.direction[c.output] != 0 && found.plan.conditions.rows.size() > 1;
    const double value = of_mean ? NAN : measured(found, design, c.output);
    const double own = std::abs(found.own.values[c.output]);
    const double scale = std::max(std::abs(c.limit), std::isfinite(own) ? own : 0);
    if (std::abs(value - c.limit) <= kAtEnd * scale) all.push_back(found.plan.text(c));
  }
  for (std::size_t k = 0; k < plan.varied.size(); ++k) {
    const Varied& varied = plan.varied[k];
    if (!varied.variable.words().empty()) continue;
    double low = 0, high = 0;
    if (varied.levels.empty()) {
      low = varied.distribution.numbers[0];
      high = varied.distribution.numbers[1];
      if (varied.variable.discrete()) {
        low = std::ceil(low);
        high = std::floor(high);
      }
    } else {
      const auto [least, most] = std::minmax_element(varied.levels.begin(), varied.levels.end());
      low = *least;
      high = *most;
    }
    const double value = found.designs.values[design * plan.varied.size() + k];
    for (const auto& [end, word] : {std::pair{low, "lower"}, {high, "upper"}})
      if (std::abs(value - end) <= kAtEnd * (high - low))
        all.push_back(fmt::format("{} at its {} end {}", varied.variable.name(), word,
                                  value_text(varied.variable, end)));
  }
  return all;
}

std::vector<std::size_t> objectives(const Optimisation& found) {
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < found.plan.designs.direction.size(); ++k)
    if (found.plan.designs.direction[k] != 0) all.push_back(k);
  return all;
}

// Of infeasible designs the one that misses the constraints least.
std::optional<std::size_t> nearest_miss(const Optimisation& found) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < found.evaluated(); ++i)
    if (std::isfinite(found.violations[i]) &&
        (!nearest || found.violations[i] < found.violations[*nearest]))
      nearest = i;
  return nearest;
}

double improvement(double before, double after) {
  const double scale = std::max(std::abs(before), std::abs(after));
  return scale > 0 ? (before - after) / scale : 0;
}

// By how much gradients improved the best value of an objective, of that value: the largest of all
// objectives. Nothing where the searches found no feasible design.
std::optional<double> largest_improvement(const Optimisation& found) {
  std::optional<double> largest;
  for (std::size_t k = 0; k < objectives(found).size(); ++k) {
    double before = INFINITY, after = INFINITY;
    for (const Refinement& r : found.search.refinements)
      if (r.objective == k) {
        before = std::fmin(before, r.before);  // which leaves out what is not there
        after = std::fmin(after, r.after);
      }
    if (std::isfinite(before))
      largest = std::max(largest.value_or(0), improvement(before, std::min(before, after)));
  }
  return largest;
}

// Best value of an objective among the designs that keep all constraints, from one up to another.
double best_value(const Optimisation& found, std::size_t output, std::size_t from, std::size_t to) {
  double best = NAN;
  const int direction = found.plan.designs.direction[output];
  for (std::size_t i = from; i < to; ++i) {
    if (found.violations[i] > 0) continue;
    const double value = measured(found, i, output);
    if (!(direction * (value - best) <= 0)) best = value;
  }
  return best;
}

// The same of one search, of the only objective.
double best_of_search(const Optimisation& found, std::size_t search) {
  const auto& counts = found.search.evaluations;
  std::size_t from = 0;
  for (std::size_t i = 0; i < search; ++i) from += counts[i];
  const std::size_t output = objectives(found).front();
  return best_value(found, output, from, from + counts[search]);
}

// How far the searches agree: of several objectives in the front, of one in its best value.
std::string searches_text(const Optimisation& found) {
  constexpr double kDisagree = 0.5;     // of the front
  constexpr double kDisagreeBy = 0.01;  // of the best value
  const std::size_t count = found.shares_of_front.size();
  if (count < 2) return "";
  const char* hint = "more --generations or a larger --population";
  if (objectives(found).size() == 1) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < count; ++i) {
      const double best = best_of_search(found, i);
      if (!is_computed(best))
        return fmt::format("search {} of {} finds no design that satisfies all constraints: {}",
                           i + 1, count, hint);
      low = std::min(low, best);
      high = std::max(high, best);
    }
    const double apart = improvement(high, low);
    return fmt::format(
        "the best values of the {} searches differ by {:.2g} %{}", count, 100 * apart,
        apart > kDisagreeBy ? fmt::format(", so the best design is not settled: {}", hint) : "");
  }
  const double least =
      *std::min_element(found.shares_of_front.begin(), found.shares_of_front.end());
  if (least >= kDisagree)
    return fmt::format("each of {} searches finds at least {:.3g} % of the front alone", count,
                       100 * least);
  return fmt::format(
      "the searches disagree: one of {} finds {} of the front alone, so the front is not settled: "
      "{}",
      count, least < 5e-4 ? std::string("nothing") : fmt::format("{:.2g} %", 100 * least), hint);
}

// Random and grid search at as many evaluations, by the same evaluator.
report::Section comparison_section(const Optimisation& found) {
  report::Section section;
  section.title = "Against random and grid search";
  section.text =
      "The same evaluations spent otherwise: designs drawn at random, and a grid with as many "
      "values of each parameter as they allow. Volume: what the front dominates below the worst "
      "point of the front found, of that of the front found; a search may be lucky above 100 %. "
      "Time: of the evaluations; the search itself takes more.";
  section.table.columns = {"search", "designs", "keep all constraints"};
  const auto sought = objectives(found);
  for (const std::size_t k : sought) {
    const Output& o = found.plan.designs.outputs[k];
    section.table.columns.push_back("best " + o.name + (o.unit.empty() ? "" : ", " + o.unit));
  }
  section.table.columns.emplace_back("volume, %");
  section.table.columns.emplace_back("time, s");
  const auto number = [](double value) {
    return is_computed(value) ? report::Cell(value) : report::Cell();
  };
  std::vector<report::Cell> own = {"optimise", static_cast<long>(found.evaluated()),
                                   static_cast<long>(found.feasible())};
  for (const std::size_t k : sought)
    own.push_back(number(best_value(found, k, 0, found.evaluated())));
  own.push_back(found.shares_of_front.empty() ? report::Cell() : report::Cell(100.0));
  own.emplace_back(found.evaluation_seconds);
  section.table.rows.push_back(std::move(own));
  for (const SearchComparison& other : found.comparisons) {
    std::vector<report::Cell> row = {other.name, static_cast<long>(other.evaluations),
                                     static_cast<long>(other.feasible)};
    for (const double best : other.best) row.push_back(number(best));
    row.push_back(is_computed(other.share_of_front) ? report::Cell(100 * other.share_of_front)
                                                    : report::Cell());
    row.emplace_back(other.seconds);
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

// "Random search with as many designs ..", for the answers.
std::string comparison_text(const Optimisation& found) {
  std::string text;
  const auto sought = objectives(found);
  for (const SearchComparison& other : found.comparisons) {
    const Output& o = found.plan.designs.outputs[sought.front()];
    const std::string result =
        other.feasible == 0  ? std::string("finds no design that keeps all constraints")
        : sought.size() == 1 ? fmt::format("comes to {}", with_unit(other.best.front(), o))
        : is_computed(other.share_of_front)
            ? fmt::format("dominates {:.3g} % of the front's volume", 100 * other.share_of_front)
            : fmt::format("comes to {} {}", o.name, with_unit(other.best.front(), o));
    text += fmt::format("{} search with {} designs {}",
                        text.empty() ? other.name : ", " + other.name, other.evaluations, result);
  }
  return text;
}

report::Section chosen_section(const Optimisation& found) {
  const SweepPlan& plan = found.plan.designs;
  report::Section section;
  section.title = "Chosen designs";
  section.text =
      "The best design for each objective, and of several objectives the one nearest to all of "
      "these at once, each objective over its range on the front (\"balanced\"). Each is a case "
      "file of its own.";
  section.table.columns = {"", "chosen for", "design"};
  for (const Varied& varied : plan.varied) section.table.columns.push_back(varied.variable.name());
  for (const Output& o : plan.outputs)
    section.table.columns.push_back(o.name + (o.unit.empty() ? "" : ", " + o.unit));
  section.table.columns.emplace_back("at its limit");
  section.table.columns.emplace_back("validity");
  std::vector<report::Cell> own = {"the case", "", ""};
  for (const Varied& varied : plan.varied)
    own.emplace_back(value_text(varied.variable, varied.variable.value(found.designs.base)));
  for (const double value : found.own.values) own.emplace_back(value);
  own.emplace_back(found.own.reason);
  own.emplace_back("");
  section.table.rows.push_back(std::move(own));
  for (std::size_t i = 0; i < found.chosen.size(); ++i) {
    const auto& [why, design] = found.chosen[i];
    std::vector<report::Cell> row = {fmt::format("chosen_{}.toml", i + 1), why,
                                     static_cast<long>(design)};
    for (std::size_t k = 0; k < plan.varied.size(); ++k)
      row.emplace_back(value_text(plan.varied[k].variable,
                                  found.designs.values[design * plan.varied.size() + k]));
    for (std::size_t k = 0; k < plan.outputs.size(); ++k)
      row.emplace_back(measured(found, design, k));
    row.emplace_back(fmt::format("{}", fmt::join(bindings(found, design), "; ")));
    row.emplace_back(i >= found.validity.size()  ? ""
                     : found.validity[i].valid() ? "valid over the whole turn"
                                                 : found.validity[i].text());
    section.table.rows.push_back(std::move(row));
  }
  return section;
}

report::Section sureness_section(const Optimisation& found) {
  const SearchOptions& options = found.plan.search;
  report::Section section;
  section.title = "How sure this is";
  section.text =
      "Searches from different points that end at the same front, and gradients that find no "
      "better design nearby, indicate convergence; no search proves that there is no better "
      "design.";
  section.facts = {
      {"search", search_libraries() + (objectives(found).size() > 1
                                           ? "; NSGA-II, then SLSQP from the best designs"
                                           : "; GACO, then SLSQP from the best designs")},
      {"population", fmt::format("{}", options.population)},
      {"generations", fmt::format("{}", options.generations)},
      {"seed", fmt::format("{}", options.seed)},
      {"time", fmt::format("{:.3g} s, {:.3g} s of it evaluations ({:.3g} designs a second)",
                           found.designs.seconds, found.evaluation_seconds,
                           static_cast<double>(found.evaluated()) / found.evaluation_seconds)}};
  section.table.columns = {"stage", "designs", "result"};
  for (std::size_t i = 0; i < options.restarts; ++i)
    section.table.rows.push_back(
        {fmt::format("search {}", i + 1), static_cast<long>(found.search.evaluations[i]),
         objectives(found).size() == 1 && is_computed(best_of_search(found, i))
             ? "best: " + with_unit(best_of_search(found, i),
                                    found.plan.designs.outputs[objectives(found).front()])
         : i < found.shares_of_front.size()
             ? fmt::format("{:.4g} % of the volume of the front", 100 * found.shares_of_front[i])
         : found.chosen.empty() ? "no feasible design"
                                : ""});
  const auto sought = objectives(found);
  for (const Refinement& r : found.search.refinements) {
    const Output& o = found.plan.designs.outputs[sought[r.objective]];
    const double sign = -found.plan.designs.direction[sought[r.objective]];
    section.table.rows.push_back(
        {"gradients, " + o.name, static_cast<long>(r.evaluations),
         !is_computed(r.after) ? "no feasible design; " + r.message
         : !is_computed(r.before)
             ? "to " + with_unit(sign * r.after, o) + "; " + r.message
             : fmt::format("from {} to {}, better by {:.2g} %; {} derivatives; {}",
                           with_unit(sign * r.before, o), with_unit(sign * r.after, o),
                           100 * improvement(r.before, r.after), r.exact ? "exact" : "difference",
                           r.message)});
  }
  return section;
}

}  // namespace

std::string headline(const Optimisation& found) {
  if (found.chosen.empty())
    return fmt::format("none of {} designs satisfies all constraints", found.evaluated());
  return fmt::format("{} designs evaluated, {} satisfy all constraints{}{}", found.evaluated(),
                     found.feasible(), found.validity.empty() ? "" : "; ",
                     found.validity.empty() ? "" : validity_text(found.validity, "chosen"));
}

std::vector<std::string> optimise_answers(const Optimisation& found) {
  const SweepPlan& plan = found.plan.designs;
  std::vector<std::string> answers;
  const SweepView view(found.designs);
  if (found.chosen.empty()) {
    if (const auto nearest = nearest_miss(found)) {
      std::string reason;
      for (const auto& [design, why] : found.designs.infeasible)
        if (design == *nearest) reason = why;
      answers.push_back(fmt::format("The design closest to feasible is design {}, {}: {}.",
                                    *nearest, view.text(*nearest), reason));
    }
    answers.emplace_back("Widen a range of --vary or relax a --subject-to.");
    return answers;
  }
  bool all_constant = true;
  for (const std::size_t k : objectives(found)) {
    std::string constant = view.constant_text(k);
    all_constant &= !constant.empty();
    if (!constant.empty()) answers.push_back(std::move(constant));
  }
  if (all_constant) {
    answers.emplace_back("There is nothing to choose: every design is as good as the others.");
    return answers;
  }
  for (std::size_t i = 0; i < found.chosen.size(); ++i) {
    const auto& [why, design] = found.chosen[i];
    std::string values;
    for (const std::size_t k : objectives(found))
      values += (values.empty() ? "" : ", ") + plan.outputs[k].name + " " +
                against_case(found, design, k);
    const auto limits = bindings(found, design);
    answers.push_back(fmt::format(
        "{} (chosen_{}.toml): {}; with {}{}{}.", why, i + 1, values, view.text(design),
        limits.empty() ? "" : fmt::format("; at its limit: {}", fmt::join(limits, ", ")),
        i < found.validity.size() && !found.validity[i].valid() ? "; " + found.validity[i].text()
                                                                : ""));
  }
  append_limits(answers, found.validity, "--subject-to");
  if (!found.own.reason.empty())
    answers.push_back("The case itself is not a feasible design: " + found.own.reason + ".");
  std::string sure = searches_text(found);
  if (const auto most = largest_improvement(found))
    sure += fmt::format("{}gradients improve the best value of an objective by {:.2g} % at most",
                        sure.empty() ? "" : ", and ", 100 * *most);
  if (!sure.empty()) answers.push_back("How sure: " + sure + ".");
  if (!found.comparisons.empty())
    answers.push_back("For comparison: " + comparison_text(found) + ".");
  return answers;
}

std::vector<std::pair<std::string, std::string>> chosen_cases(const Optimisation& found) {
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t i = 0; i < found.chosen.size(); ++i) {
    const auto& [why, design] = found.chosen[i];
    Case chosen = case_of(found, design);
    chosen.name += ", " + why;
    std::string head = fmt::format("# Chosen by bentaxis optimise: {}, design {}.\n", why, design);
    for (const std::size_t k : objectives(found))
      head += fmt::format("# {}: {}\n", found.plan.designs.outputs[k].name,
                          against_case(found, design, k));
    for (const Constraint& c : found.plan.constraints)
      head += "# Keeps " + found.plan.text(c) + ".\n";
    if (i < found.validity.size()) {
      const DesignValidity& validity = found.validity[i];
      for (const std::string& limit : validity.limits) head += "# " + limit + "\n";
      if (!validity.reason.empty()) head += "# " + validity.text() + "\n";
    }
    files.emplace_back(fmt::format("chosen_{}.toml", i + 1), head + case_text(chosen));
  }
  return files;
}

report::Document optimise_document(const Optimisation& found, const report::Lines& program,
                                   const study::CaseDescription& description) {
  const SweepView view(found.designs);
  report::Document document =
      study::case_document(description, found.designs.base.name + ": the best designs", program);
  document.verdict = report::Verdict{std::nullopt, headline(found)};
  document.verdict->word = "Optimised";
  if (found.chosen.empty()) {
    document.verdict->agrees = false;
    document.verdict->word = "No design";
  }
  document.verdict->answers = optimise_answers(found);
  document.verdict->not_valid = not_valid_designs(found.validity, "chosen");
  document.meaning =
      "Designs by one model, the best that a search found. Nothing was compared: run compare on a "
      "chosen design before it is built.";
  document.runs.emplace();
  document.runs->push_back(chosen_section(found));
  if (!found.chosen.empty()) document.runs->push_back(best_section(view));
  report::Section varied = plan_section(found.designs, view);
  for (std::size_t k = 0; k < found.plan.designs.varied.size(); ++k) {
    const Varied& one = found.plan.designs.varied[k];
    if (one.levels.empty() && !one.variable.discrete())
      varied.table.rows[k][2] =
          fmt::format("{} to {}", one.distribution.numbers[0], one.distribution.numbers[1]);
  }
  varied.facts = {{"model", study::to_string(found.plan.designs.model)}};
  if (found.plan.robust())
    varied.facts.emplace_back(
        "quantiles", fmt::format("of {} samples of [uncertainty] for each design, the same random "
                                 "numbers for all designs",
                                 found.plan.samples));
  for (const Constraint& c : found.plan.constraints)
    varied.facts.emplace_back("constraint", found.plan.text(c));
  if (!found.plan.conditions.file.empty()) {
    varied.facts.emplace_back("operating points",
                              fmt::format("{} of {}", found.plan.conditions.rows.size(),
                                          found.plan.conditions.file.filename().string()));
    varied.text =
        "Outputs are means over the operating points, weighted by their shares of the time; every "
        "constraint holds at each of them.";
  }
  document.runs->push_back(std::move(varied));
  document.runs->push_back(outputs_section(view));
  document.runs->push_back(sureness_section(found));
  if (!found.comparisons.empty()) document.runs->push_back(comparison_section(found));
  if (!found.designs.infeasible.empty())
    document.runs->push_back(infeasible_section(found.designs, view));
  document.figures = sweep_figures(view);
  return document;
}

}  // namespace bentaxis::designs

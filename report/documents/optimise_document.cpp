#include "bentaxis/designs/optimise_document.h"

#include "bentaxis/files/case_writer.h"
#include "document_parts.h"
#include "sweep_sections.h"
#include "sweep_view.h"

namespace bentaxis::designs {
namespace {

using report::each_of;

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

// Name and unit of an output.
std::string heading(const Optimisation& found, std::size_t output) {
  const Output& o = found.plan.designs.outputs[output];
  return o.name + (o.unit.empty() ? "" : ", " + o.unit);
}

// The lowest and the highest value that a parameter may have.
std::pair<double, double> ends_of(const Varied& varied) {
  if (!varied.levels.empty()) {
    const auto [least, most] = std::ranges::minmax(varied.levels);
    return {least, most};
  }
  const double low = varied.distribution.numbers[0], high = varied.distribution.numbers[1];
  if (varied.variable.discrete()) return {std::ceil(low), std::floor(high)};
  return {low, high};
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
    const auto [low, high] = ends_of(varied);
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
  const double least = *std::ranges::min_element(found.shares_of_front);
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
  report::NewSection section(
      "Against random and grid search",
      "The same evaluations spent otherwise: designs drawn at random, and a grid with as many "
      "values of each parameter as they allow. Volume: what the front dominates below the worst "
      "point of the front found, of that of the front found; a search may be lucky above 100 %. "
      "Time: of the evaluations; the search itself takes more.");
  const auto sought = objectives(found);
  section.columns("search", "designs", "keep all constraints",
                  each_of(sought, [&](std::size_t k) { return "best " + heading(found, k); }),
                  "volume, %", "time, s");
  section.row(
      "optimise", found.evaluated(), found.feasible(),
      each_of(sought, [&](std::size_t k) { return best_value(found, k, 0, found.evaluated()); }),
      found.shares_of_front.empty() ? not_computed() : 100, found.evaluation_seconds);
  for (const SearchComparison& other : found.comparisons)
    section.row(other.name, other.evaluations, other.feasible, other.best,
                100 * other.share_of_front, other.seconds);
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
  report::NewSection section(
      "Chosen designs",
      "The best design for each objective, and of several objectives the one nearest to all of "
      "these at once, each objective over its range on the front (\"balanced\"). Each is a case "
      "file of its own.");
  std::vector<std::string> outputs;
  for (std::size_t k = 0; k < plan.outputs.size(); ++k) outputs.push_back(heading(found, k));
  section.columns("", "chosen for", "design",
                  each_of(plan.varied, [](const Varied& v) { return v.variable.name(); }), outputs,
                  "at its limit", "validity");
  section.row("the case", "", "",
              each_of(plan.varied,
                      [&](const Varied& v) {
                        return value_text(v.variable, v.variable.value(found.designs.base));
                      }),
              found.own.values, found.own.reason, "");
  for (std::size_t i = 0; i < found.chosen.size(); ++i) {
    const auto& [why, design] = found.chosen[i];
    report::Row values;
    for (std::size_t k = 0; k < plan.varied.size(); ++k)
      values.emplace_back(value_text(plan.varied[k].variable,
                                     found.designs.values[design * plan.varied.size() + k]));
    for (std::size_t k = 0; k < plan.outputs.size(); ++k)
      values.emplace_back(measured(found, design, k));
    section.row(fmt::format("chosen_{}.toml", i + 1), why, design, values,
                joined(bindings(found, design), "; "),
                i >= found.validity.size()  ? ""
                : found.validity[i].valid() ? "valid over the whole turn"
                                            : found.validity[i].text());
  }
  return section;
}

// What one of the searches found.
std::string search_result(const Optimisation& found, std::size_t search) {
  const auto sought = objectives(found);
  if (sought.size() == 1 && is_computed(best_of_search(found, search)))
    return "best: " +
           with_unit(best_of_search(found, search), found.plan.designs.outputs[sought.front()]);
  if (search < found.shares_of_front.size())
    return fmt::format("{:.4g} % of the volume of the front", 100 * found.shares_of_front[search]);
  return found.chosen.empty() ? "no feasible design" : "";
}

std::string refinement_text(const Optimisation& found, const Refinement& r) {
  const std::size_t output = objectives(found)[r.objective];
  const auto value = [&](double minimised) {
    return with_unit(-found.plan.designs.direction[output] * minimised,
                     found.plan.designs.outputs[output]);
  };
  if (!is_computed(r.after)) return "no feasible design; " + r.message;
  if (!is_computed(r.before)) return "to " + value(r.after) + "; " + r.message;
  return fmt::format("from {} to {}, better by {:.2g} %; {} derivatives; {}", value(r.before),
                     value(r.after), 100 * improvement(r.before, r.after),
                     r.exact ? "exact" : "difference", r.message);
}

report::Section sureness_section(const Optimisation& found) {
  const SearchOptions& options = found.plan.search;
  const auto sought = objectives(found);
  report::NewSection section(
      "How sure this is",
      "Searches from different points that end at the same front, and gradients that find no "
      "better design nearby, indicate convergence; no search proves that there is no better "
      "design.");
  section.fact("search", search_libraries() + (sought.size() > 1
                                                   ? "; NSGA-II, then SLSQP from the best designs"
                                                   : "; GACO, then SLSQP from the best designs"));
  section.fact("population", "{}", options.population);
  section.fact("generations", "{}", options.generations);
  section.fact("seed", "{}", options.seed);
  section.fact("time", "{:.3g} s, {:.3g} s of it evaluations ({:.3g} designs a second)",
               found.designs.seconds, found.evaluation_seconds,
               static_cast<double>(found.evaluated()) / found.evaluation_seconds);
  section.columns("stage", "designs", "result");
  for (std::size_t i = 0; i < options.restarts; ++i)
    section.row(fmt::format("search {}", i + 1), found.search.evaluations[i],
                search_result(found, i));
  for (const Refinement& r : found.search.refinements)
    section.row("gradients, " + found.plan.designs.outputs[sought[r.objective]].name, r.evaluations,
                refinement_text(found, r));
  return section;
}

// What was varied, with the rules of the search.
report::Section varied_section(const Optimisation& found, const SweepView& view) {
  const SweepPlan& plan = found.plan.designs;
  report::Section section = plan_section(found.designs, view);
  for (std::size_t k = 0; k < plan.varied.size(); ++k) {
    const Varied& one = plan.varied[k];
    if (one.levels.empty() && !one.variable.discrete())
      section.table.rows[k][2] =
          fmt::format("{} to {}", one.distribution.numbers[0], one.distribution.numbers[1]);
  }
  section.facts = {{"model", study::to_string(plan.model)}};
  if (found.plan.robust())
    section.facts.emplace_back(
        "quantiles", fmt::format("of {} samples of [uncertainty] for each design, the same random "
                                 "numbers for all designs",
                                 found.plan.samples));
  for (const Constraint& c : found.plan.constraints)
    section.facts.emplace_back("constraint", found.plan.text(c));
  if (found.plan.conditions.file.empty()) return section;
  section.facts.emplace_back("operating points",
                             fmt::format("{} of {}", found.plan.conditions.rows.size(),
                                         found.plan.conditions.file.filename().string()));
  section.text =
      "Outputs are means over the operating points, weighted by their shares of the time; every "
      "constraint holds at each of them.";
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
  const bool none = found.chosen.empty();
  document.verdict = {.agrees = none ? std::optional(false) : std::nullopt,
                      .headline = headline(found),
                      .word = none ? "No design" : "Optimised",
                      .not_valid = not_valid_designs(found.validity, "chosen"),
                      .answers = optimise_answers(found)};
  document.meaning =
      "Designs by one model, the best that a search found. Nothing was compared: run compare on a "
      "chosen design before it is built.";
  document.runs = {chosen_section(found)};
  if (!none) document.runs->push_back(best_section(view));
  document.runs->push_back(varied_section(found, view));
  document.runs->push_back(outputs_section(view));
  document.runs->push_back(sureness_section(found));
  if (!found.comparisons.empty()) document.runs->push_back(comparison_section(found));
  if (!found.designs.infeasible.empty())
    document.runs->push_back(infeasible_section(found.designs, view));
  document.figures = sweep_figures(view);
  return document;
}

}  // namespace bentaxis::designs

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bentaxis/designs/sensitivity.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/study/memory.h"
#include "optimise_pieces.h"

namespace bentaxis::designs {
namespace {

Family family_of(const Case& base, const OptimisePlan& plan) {
  std::vector<Variable> all;
  for (const Varied& varied : plan.designs.varied) all.push_back(varied.variable);
  const auto& conditions = plan.conditions.variables;
  all.insert(all.end(), conditions.begin(), conditions.end());
  return {base, std::move(all)};
}

}  // namespace

DesignProblem::DesignProblem(Case the_case, OptimisePlan the_plan)
    : base(std::move(the_case)),
      plan(std::move(the_plan)),
      evaluator(family_of(base, plan), plan.computed, plan.designs.model) {
  for (const Varied& varied : plan.designs.varied) variables.push_back(search_variable(varied));
  for (std::size_t k = 0; k < plan.designs.direction.size(); ++k)
    if (plan.designs.direction[k] != 0) objectives.push_back(k);
  if (plan.robust()) {
    std::vector<QuantileOutput> wanted;
    for (std::size_t k = 0; k < computed(); ++k)
      if (plan.quantiles[k]) wanted.push_back({plan.computed[k], *plan.quantiles[k]});
    quantiles.emplace(base, evaluator.family().variables(), std::move(wanted), plan.samples,
                      plan.search.seed, plan.designs.model);
  }
  // Designs with their outputs twice, their costs, constraints and violation, and a reason each.
  const double numbers = static_cast<double>(variables.size() + 2 * outputs() + objectives.size() +
                                             plan.constraints.size() + 1);
  study::require_memory(
      static_cast<double>(plan.evaluations()) * (numbers * sizeof(double) + sizeof(std::string)),
      fmt::format("optimise: {} of {} and {}", counted(plan.evaluations(), "design"),
                  counted(variables.size(), "variable"), counted(outputs(), "output")),
      "lower --population, --generations or --restarts");
  std::vector<double> values;
  for (const Varied& varied : plan.designs.varied) values.push_back(varied.variable.value(base));
  std::vector<double> raw(rows() * computed());
  own.reason = compute(values, raw);
  own.values = outputs_in(raw);
  for (const Constraint& c : plan.constraints) {
    const double here = std::abs(own.values[c.output]);
    scales.push_back(std::max(std::abs(c.limit), std::isfinite(here) ? here : 0));
    if (!(scales.back() > 0)) scales.back() = 1;
  }
  if (own.reason.empty()) own.reason = violated(raw);
}

std::vector<double> DesignProblem::values_at(std::span<const double> x) const {
  std::vector<double> values(x.begin(), x.end());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (const auto& levels = plan.designs.varied[k].levels; !levels.empty())
      values[k] = levels[static_cast<std::size_t>(values[k])];
  return values;
}

std::vector<double> DesignProblem::point_of(const std::vector<double>& values) const {
  std::vector<double> x = values;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (const auto& levels = plan.designs.varied[k].levels; !levels.empty())
      x[k] = static_cast<double>(std::min_element(levels.begin(), levels.end(),
                                                  [&](double a, double b) {
                                                    return std::abs(a - values[k]) <
                                                           std::abs(b - values[k]);
                                                  }) -
                                 levels.begin());
    x[k] = std::clamp(x[k], variables[k].low, variables[k].high);
    if (variables[k].whole) x[k] = std::round(x[k]);
  }
  return x;
}

std::string DesignProblem::put_quantiles(std::span<const double> values,
                                         std::span<double> raw) const {
  std::vector<double> found(computed());  // as many as there may be
  std::string why = quantiles->evaluate(values, found);
  auto next = found.begin();
  for (std::size_t k = 0; k < computed(); ++k)
    if (plan.quantiles[k]) raw[k] = *next++;
  return why;
}

std::string DesignProblem::compute(std::span<const double> values, std::span<double> raw) const {
  std::string reason;
  for (std::size_t row = 0; row < rows(); ++row) {
    std::vector<double> all(values.begin(), values.end());
    const auto& condition = plan.conditions.rows[row];
    all.insert(all.end(), condition.values.begin(), condition.values.end());
    const auto here = raw.subspan(row * computed(), computed());
    std::string why;
    evaluator.evaluate(1, all, here, {&why, 1});
    if (why.empty() && quantiles) why = put_quantiles(all, here);
    if (!why.empty() && reason.empty())
      reason = rows() == 1 ? why : plan.conditions.name_of(row) + ": " + why;
  }
  if (!reason.empty()) std::fill(raw.begin(), raw.end(), not_computed());
  return reason;
}

void DesignProblem::compute(std::span<const double> values, std::span<double> raw,
                            std::span<std::string> reasons) const {
  if (rows() == 1 && plan.conditions.variables.empty() && !quantiles)
    return evaluator.evaluate(reasons.size(), values, raw, reasons);
  const std::size_t n = variables.size(), m = rows() * computed();
  for (std::size_t i = 0; i < reasons.size(); ++i)
    reasons[i] = compute(values.subspan(i * n, n), raw.subspan(i * m, m));
}

double DesignProblem::value_at(std::size_t output, std::size_t row,
                               std::span<const double> raw) const {
  return raw[row * computed() + plan.taken[output].from];
}

double DesignProblem::beyond(const Constraint& c, std::span<const double> raw) const {
  double worst = -std::numeric_limits<double>::infinity();
  const auto& only = plan.taken[c.output].row;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (only && row != *only) continue;
    const double value = value_at(c.output, row, raw);
    const double over = c.at_most ? value - c.limit : c.limit - value;
    if (!(over <= worst)) worst = over;  // NaN stays
    if (std::isnan(worst)) break;
  }
  return worst;
}

double DesignProblem::mean(std::size_t output, std::span<const double> raw) const {
  if (const auto& only = plan.taken[output].row) return value_at(output, *only, raw);
  if (rows() == 1) return value_at(output, 0, raw);
  double sum = 0, shares = 0;
  for (std::size_t row = 0; row < rows(); ++row) {
    sum += plan.conditions.rows[row].share * value_at(output, row, raw);
    shares += plan.conditions.rows[row].share;
  }
  return sum / shares;
}

std::vector<double> DesignProblem::outputs_in(std::span<const double> raw) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < outputs(); ++k) values.push_back(mean(k, raw));
  for (const Constraint& c : plan.constraints)
    if (plan.designs.direction[c.output] == 0)
      values[c.output] = c.limit + (c.at_most ? 1 : -1) * beyond(c, raw);
  return values;
}

std::string DesignProblem::violated(std::span<const double> raw) const {
  std::string text;
  for (const Constraint& c : plan.constraints)
    if (const double over = beyond(c, raw); !(over <= 0))
      text +=
          (text.empty() ? "" : "; ") + plan.text(c) + ": " +
          (std::isnan(over) ? "has no value"
                            : fmt::format("{} by {:.4g}{}", c.at_most ? "exceeded" : "missed", over,
                                          unit_after(plan.designs.outputs[c.output].unit)));
  return text;
}

void DesignProblem::numbers_of(std::span<const double> raw, std::span<double> numbers) const {
  std::size_t next = 0;
  for (const std::size_t k : objectives)
    numbers[next++] = -plan.designs.direction[k] * mean(k, raw);
  for (std::size_t i = 0; i < plan.constraints.size(); ++i)
    numbers[next++] = beyond(plan.constraints[i], raw) / scales[i];
}

bool DesignProblem::differentiate(std::span<const double> x, std::span<double> jacobian) const {
  if (!evaluator.fast() || rows() != 1 || !plan.conditions.variables.empty() || quantiles)
    return false;
  for (const SearchVariable& v : variables)
    if (v.whole) return false;
  Case here = base;
  evaluator.family().make(values_at(x), here);
  std::vector<Variable> varied;
  for (const Varied& v : plan.designs.varied) varied.push_back(v.variable);
  std::vector<Output> wanted;
  std::vector<double> factors;
  for (const std::size_t k : objectives) {
    wanted.push_back(plan.designs.outputs[k]);
    factors.push_back(-plan.designs.direction[k]);
  }
  for (std::size_t i = 0; i < plan.constraints.size(); ++i) {
    wanted.push_back(plan.designs.outputs[plan.constraints[i].output]);
    factors.push_back((plan.constraints[i].at_most ? 1 : -1) / scales[i]);
  }
  const auto is_exact = [](const Output& o) { return o.source == Source::curve; };
  if (!std::all_of(wanted.begin(), wanted.end(), is_exact)) return false;  // by differences there
  const Sensitivities found = sensitivities(here, varied, wanted, plan.designs.model);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    for (std::size_t k = 0; k < varied.size(); ++k) {
      const Derivative& d = found.derivatives[i][k];
      if (d.way != Way::exact || !std::isfinite(d.value)) return false;
      jacobian[i * varied.size() + k] = factors[i] * d.value;
    }
  return true;
}

}  // namespace bentaxis::designs

#include "bentaxis/designs/design_validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

#include "bentaxis/designs/optimise.h"
#include "bentaxis/designs/sweep.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/turn_summary.h"

namespace bentaxis::designs {
namespace {

// A design of values of variables.
Case case_with(const Case& base, const std::vector<Variable>& variables,
               std::span<const double> values) {
  Case made = base;
  Family(base, variables).make(values, made);
  return made;
}

std::vector<Variable> variables_of(const SweepPlan& plan) {
  std::vector<Variable> variables;
  for (const Varied& varied : plan.varied) variables.push_back(varied.variable);
  return variables;
}

// The design with the best value of an output.
std::optional<std::size_t> best_by(const SweepResult& result, std::size_t output) {
  const std::size_t m = result.plan.outputs.size();
  const int direction = result.plan.direction[output];
  std::optional<std::size_t> best;
  for (std::size_t d = 0; d < result.designs; ++d) {
    const double value = result.results[d * m + output];
    if (is_computed(value) &&
        (!best || direction * (value - result.results[*best * m + output]) > 0))
      best = d;
  }
  return best;
}

}  // namespace

std::string DesignValidity::text() const {
  if (!reason.empty()) return "limits of validity not checked: " + reason;
  if (limits.empty()) return "";
  return fmt::format("not valid over {:.3g} % of the turn{}{}", 100 * share,
                     where.empty() ? "" : ", ", where);
}

DesignValidity validity_of(const Case& the_case) {
  DesignValidity found;
  try {
    const study::PreparedCase ready = study::prepare(the_case);
    const auto limits = study::limits_of_turn(
        ready.the_case, ready.assumptions(study::Model::analytic), ready.pressure);
    found.limits = study::limit_answers(limits);
    found.share = analytic::share_beyond(limits);
    for (const analytic::ValidityLimit& limit : limits)
      if (limit.applicable && limit.violated_share > 0) found.keys.push_back(limit.key);
  } catch (const InputError& error) {
    found.reason = error.what();
  } catch (const ComputationError& error) {
    found.reason = error.what();
  }
  return found;
}

std::vector<DesignValidity> validity_of_best(const SweepResult& result) {
  std::vector<DesignValidity> all;
  const std::size_t n = result.plan.varied.size();
  for (std::size_t k = 0; k < result.plan.direction.size(); ++k) {
    if (result.plan.direction[k] == 0) continue;
    const auto best = best_by(result, k);
    if (!best || std::any_of(all.begin(), all.end(),
                             [&](const DesignValidity& v) { return v.design == *best; }))
      continue;
    all.push_back(
        validity_of(case_with(result.base, variables_of(result.plan),
                              std::span<const double>(result.values).subspan(*best * n, n))));
    all.back().design = *best;
  }
  return all;
}

std::vector<DesignValidity> validity_of_chosen(const Optimisation& found) {
  const DutyCycle& conditions = found.plan.conditions;
  const std::size_t n = found.plan.designs.varied.size();
  std::vector<Variable> variables = variables_of(found.plan.designs);
  variables.insert(variables.end(), conditions.variables.begin(), conditions.variables.end());
  std::vector<DesignValidity> all;
  for (const ChosenDesign& chosen : found.chosen) {
    std::optional<DesignValidity> worst;
    for (std::size_t row = 0; row < conditions.rows.size(); ++row) {
      const auto from =
          found.designs.values.begin() + static_cast<std::ptrdiff_t>(chosen.design * n);
      std::vector<double> values(from, from + static_cast<std::ptrdiff_t>(n));
      const std::vector<double>& here = conditions.rows[row].values;
      values.insert(values.end(), here.begin(), here.end());
      DesignValidity one = validity_of(case_with(found.designs.base, variables, values));
      if (!conditions.variables.empty()) one.where = conditions.name_of(row);
      const auto rank = [](const DesignValidity& v) {
        return v.reason.empty() ? v.share : 2;  // nothing is known there
      };
      if (!worst || rank(one) > rank(*worst)) worst = std::move(one);
    }
    if (!worst) continue;
    worst->design = chosen.design;
    all.push_back(std::move(*worst));
  }
  return all;
}

}  // namespace bentaxis::designs

#include "bentaxis/designs/sensitivity.h"

#include <cmath>
#include <utility>

#include "bentaxis/compare/difference.h"
#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/independence.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/full_key.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/piece_progress.h"
#include "derivatives.h"

namespace bentaxis::designs {
namespace {

Sensitivities begin(const Case& base, const std::vector<Variable>& variables,
                    const std::vector<Output>& outputs, study::Model model) {
  Sensitivities s;
  s.base = base;
  s.model = model;
  s.variables = variables;
  s.outputs = outputs;
  for (const Variable& variable : variables) {
    if (variable.discrete())
      throw InputError(variable.name() + ": is not a continuous number: it has no derivative");
    s.at.push_back(variable.value(base));
  }
  std::vector<Output> all = outputs;
  for (Output output : outputs) {
    if (output.source == Source::curve || output.source == Source::budget)
      output.statistic = Statistic::peak;
    all.push_back(output);
  }
  const std::vector<double> found = Evaluator(Family(base, {}), all, model).outputs_at({});
  const auto half = found.begin() + static_cast<std::ptrdiff_t>(outputs.size());
  s.values.assign(found.begin(), half);
  s.scales.assign(half, found.end());
  for (double& scale : s.scales) scale = std::abs(scale);
  for (std::size_t o = 0; o < outputs.size(); ++o)
    s.derivatives.emplace_back(variables.size(), Derivative{not_computed()});
  return s;
}

std::vector<std::size_t> independent_outputs(const Sensitivities& s) {
  return numbers(s.outputs.size(),
                 [&](std::size_t o) { return why_not_independent(s.outputs[o], s.base).empty(); });
}

}  // namespace

std::string to_string(Way way) {
  switch (way) {
    case Way::exact:
      return "exact";
    case Way::forward:
      return "forward sensitivities (CVODES)";
    case Way::differences:
      break;
  }
  return "differences";
}

double Sensitivities::elasticity(std::size_t output, std::size_t variable) const {
  if (at[variable] == 0 || values[output] == 0) return not_computed();
  return derivatives[output][variable].value * at[variable] / values[output];
}

std::vector<Variable> continuous_variables(const Case& base) {
  std::vector<Variable> variables;
  for (const Table& table : standard_registry().tables) {
    // What an integration in time starts and is driven by changes no driven turn.
    if (table.name == "drive" || table.name.starts_with("assumptions")) continue;
    for (const Parameter& p : table.parameters)
      for (const std::string& name : number_names(table, p)) try {
          variables.emplace_back(name, base);
        } catch (const InputError&) {
          continue;  // it does nothing in this case
        }
  }
  return variables;
}

Sensitivities sensitivities(const Case& base, const std::vector<Variable>& variables,
                            const std::vector<Output>& outputs, study::Model model,
                            const study::PartProgress& progress_of, bool keep_finished) {
  study::require_memory(base, study::Kept::table, study::Way::driven);
  Sensitivities s = begin(base, variables, outputs, model);
  const Pairs exact = find_exact(s, progress_of);

  // Of the outputs that differences are needed of alone, so that these can be quick.
  std::vector<std::vector<std::size_t>> wanted;
  std::vector<std::size_t> by_differences;
  for (std::size_t v = 0; v < variables.size(); ++v) {
    wanted.push_back(numbers(outputs.size(), [&](std::size_t o) {
      return is_computed(s.values[o]) &&
             !(contains(exact.outputs, o) && contains(exact.variables, v));
    }));
    if (!wanted.back().empty()) by_differences.push_back(v);
  }
  if (by_differences.empty()) return s;
  const Progress progress = progress_of("derivatives");
  std::size_t done = 0;
  try {
    for (; done < by_differences.size(); ++done)
      find_by_differences(s, by_differences[done], wanted[by_differences[done]],
                          study::within(progress, done, by_differences.size()));
    if (progress) progress(1);
  } catch (const Interrupted&) {
    if (!keep_finished || done == by_differences.size() || (done == 0 && exact.empty())) throw;
    for (; done < by_differences.size(); ++done) {
      const std::size_t v = by_differences[done];
      s.left_out.push_back(variables[v].name());
      for (const std::size_t o : wanted[v])
        s.derivatives[o][v] = {not_computed(), 0, Way::differences, "not computed: interrupted"};
    }
  }
  return s;
}

SensitivityCheck compare_derivatives(const Sensitivities& found, Sensitivities other) {
  SensitivityCheck result{std::move(other), {}};
  result.differences.assign(found.outputs.size(),
                            std::vector<double>(found.variables.size(), not_computed()));
  for (const std::size_t o : independent_outputs(found))
    for (std::size_t v = 0; v < found.variables.size(); ++v) {
      const double size = found.at[v] == 0 ? 1 : std::abs(found.at[v]);
      const double over_scale = size / (found.scales[o] > 0 ? found.scales[o] : 1);
      const Derivative &one = found.derivatives[o][v], &two = result.other.derivatives[o][v];
      const compare::Difference apart = compare::difference(one.value, two.value, 1);
      const double difference = result.differences[o][v] = apart.share() * over_scale;
      const Derivative& missing = is_computed(one.value) ? two : one;
      const bool refused = !missing.reason.empty() && missing.reason != kNoDifferences;
      if (apart.known() ? (one.error + two.error) * over_scale > SensitivityCheck::kTolerance
                        : apart.comparable == compare::Comparable::both_missing || refused) {
        ++result.missing;
      } else if (!apart.known()) {
        ++result.lacking;
      } else {
        ++result.compared;
        if (difference > result.worst) {
          result.worst = difference;
          result.output = o;
          result.variable = v;
        }
      }
    }
  result.shared = found.outputs.size() * found.variables.size() - result.missing - result.lacking -
                  result.compared;
  return result;
}

SensitivityCheck check(const Sensitivities& found, const study::PartProgress& progress_of) {
  const study::Model model =
      found.model == study::Model::analytic ? study::Model::multibody : study::Model::analytic;
  Sensitivities other = begin(found.base, found.variables, found.outputs, model);
  const Progress progress = progress_of("derivatives of " + study::to_string(model));
  const std::vector<std::size_t> outputs = independent_outputs(found);
  for (std::size_t v = 0; v < found.variables.size(); ++v)
    find_by_differences(other, v, outputs, study::within(progress, v, found.variables.size()));
  if (progress) progress(1);
  return compare_derivatives(found, std::move(other));
}

}  // namespace bentaxis::designs

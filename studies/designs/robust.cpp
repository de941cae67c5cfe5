#include "bentaxis/designs/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/designs/distribution.h"
#include "bentaxis/designs/points.h"
#include "bentaxis/designs/propagation.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/failed_point.h"

namespace bentaxis::designs {
namespace {

std::size_t place_of(const std::vector<Variable>& variables, const Variable& wanted) {
  return static_cast<std::size_t>(
      std::find_if(variables.begin(), variables.end(),
                   [&](const Variable& v) { return v.name() == wanted.name(); }) -
      variables.begin());
}

std::vector<Variable> with_uncertain(std::vector<Variable> variables,
                                     const std::vector<Variable>& uncertain) {
  for (const Variable& v : uncertain)
    if (place_of(variables, v) == variables.size()) variables.push_back(v);
  return variables;
}

std::vector<Output> outputs_in(const std::vector<QuantileOutput>& wanted) {
  std::vector<Output> outputs;
  for (const QuantileOutput& q : wanted) outputs.push_back(q.output);
  return outputs;
}

// A distribution of what varies that stays where it is would make every design the same.
void must_move(const Case& base, const UncertainVariables& uncertain,
               const std::vector<Variable>& variables) {
  for (std::size_t i = 0; i < uncertain.size(); ++i) {
    const Variable& v = uncertain.variables[i];
    if (place_of(variables, v) == variables.size()) continue;
    const auto given =
        std::find_if(base.uncertainty.parameters.begin(), base.uncertainty.parameters.end(),
                     [&](const auto& p) { return p.name == v.name(); });
    const double here = v.value(base);
    const Distribution elsewhere =
        distribution(given->distribution, v.name(), here == 0 ? 1 : 2 * here);
    if (elsewhere.numbers != uncertain.distributions[i].numbers) continue;
    throw InputError("[uncertainty] " + v.name() + " = " + given->distribution +
                     ": varies, and its distribution does not follow its value; give it about the "
                     "value, as normal(0.1) or relative(0.01)");
  }
}

}  // namespace

struct QuantileEvaluator::Implementation {
  std::vector<QuantileOutput> outputs;
  Family designs;
  UncertainVariables uncertain;     // of the base
  Evaluator evaluator;              // of designs and what is uncertain
  std::vector<std::size_t> places;  // of what is uncertain, among its variables
  std::size_t samples;
  std::vector<double> shares;  // samples x uncertain
  std::vector<QuantileRule> rules;

  Implementation(const Case& base, const std::vector<Variable>& variables,
                 std::vector<QuantileOutput> wanted, std::size_t count, std::uint64_t seed,
                 study::Model model)
      : outputs(std::move(wanted)),
        designs(base, variables),
        uncertain(uncertain_variables(base)),
        evaluator(Family(base, with_uncertain(variables, uncertain.variables)), outputs_in(outputs),
                  model),
        samples(count) {
    must_move(base, uncertain, variables);
    for (const QuantileOutput& q : outputs) {
      if (const std::size_t fewest = QuantileRule::fewest(q.share); samples < fewest)
        throw InputError(fmt::format("--samples {}: a quantile of {:g} % of {} needs {} at least",
                                     samples, 100 * q.share, q.output.name, fewest));
      rules.emplace_back(q.share, samples);
    }
    for (const Variable& v : uncertain.variables)
      places.push_back(place_of(evaluator.family().variables(), v));
    const auto points = random(uncertain.size(), samples, seed);
    shares.resize(samples * uncertain.size());
    for (std::size_t i = 0; i < samples; ++i)
      points->point(i, std::span(shares).subspan(i * uncertain.size(), uncertain.size()));
  }

  void find(std::span<const double> values, std::span<double> results) const {
    Case here = designs.base();
    designs.make(values, here);
    const UncertainVariables about = uncertain_variables(here);
    const std::size_t width = evaluator.family().variables().size(), m = outputs.size();
    std::vector<double> all(samples * width), found(samples * m), drawn(uncertain.size());
    std::vector<std::string> reasons(samples);
    for (std::size_t i = 0; i < samples; ++i) {
      const auto row = std::span(all).subspan(i * width, width);
      std::copy(values.begin(), values.end(), row.begin());
      about.values(std::span(shares).subspan(i * uncertain.size(), uncertain.size()), drawn);
      for (std::size_t k = 0; k < drawn.size(); ++k) row[places[k]] = drawn[k];
    }
    evaluator.evaluate(samples, all, found, reasons);
    const auto refused = static_cast<std::size_t>(std::count_if(
        reasons.begin(), reasons.end(), [](const std::string& why) { return !why.empty(); }));
    if (refused > 0)
      throw ComputationError(fmt::format(
          "{} of {} samples of [uncertainty] have no values; the first: {}", refused, samples,
          *std::find_if(reasons.begin(), reasons.end(),
                        [](const std::string& why) { return !why.empty(); })));
    for (std::size_t k = 0; k < m; ++k) {
      std::vector<double> column;
      for (std::size_t i = k; i < found.size(); i += m) column.push_back(found[i]);
      if (std::all_of(column.begin(), column.end(), is_computed)) {
        std::sort(column.begin(), column.end());
        results[k] = rules[k](column).value;
      } else {
        results[k] = not_computed();
      }
    }
  }
};

QuantileEvaluator::QuantileEvaluator(const Case& base, const std::vector<Variable>& variables,
                                     std::vector<QuantileOutput> outputs, std::size_t samples,
                                     std::uint64_t seed, study::Model model)
    : implementation_(std::make_unique<Implementation>(base, variables, std::move(outputs), samples,
                                                       seed, model)) {}
QuantileEvaluator::~QuantileEvaluator() = default;
QuantileEvaluator::QuantileEvaluator(QuantileEvaluator&&) noexcept = default;

std::size_t QuantileEvaluator::samples() const { return implementation_->samples; }

std::string QuantileEvaluator::evaluate(std::span<const double> values,
                                        std::span<double> results) const {
  std::string why = study::reason_of([&] { implementation_->find(values, results); });
  if (!why.empty()) std::fill(results.begin(), results.end(), not_computed());
  return why;
}

}  // namespace bentaxis::designs

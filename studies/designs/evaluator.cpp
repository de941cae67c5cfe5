#include "bentaxis/designs/evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bentaxis/numerics/object_pool.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/run.h"
#include "turn_statistics.h"

namespace bentaxis::designs {

struct Evaluator::Implementation {
  Implementation(Family the_family, std::vector<Output> the_outputs, study::Model the_model);

  Family family;
  std::vector<Output> outputs;
  study::Model model;
  std::optional<TurnOutputs> kernel;  // where the kernel gives all outputs

  // What one thread works in.
  struct Scratch {
    Case the_case;
    std::optional<TurnStatistics> turn;
  };
  mutable numerics::ObjectPool<Scratch> scratches;

  Scratch fresh() const {
    Scratch scratch{family.base(), {}};
    if (kernel) scratch.turn.emplace(*kernel);
    return scratch;
  }

  // Of a case that is valid.
  void find(Scratch& scratch, std::span<double> results) const {
    if (scratch.turn && scratch.turn->find(scratch.the_case, results)) return;
    std::optional<study::PreparedCase> ready;
    const std::vector<double> found = outputs_of(outputs, scratch.the_case, ready, model);
    std::copy(found.begin(), found.end(), results.begin());
  }
};

Evaluator::Implementation::Implementation(Family the_family, std::vector<Output> the_outputs,
                                          study::Model the_model)
    : family(std::move(the_family)), outputs(std::move(the_outputs)), model(the_model) {
  if (model == study::Model::analytic && stays_in_reach(family))
    kernel = turn_outputs(outputs, family.base());
  if (!kernel) {
    study::require_memory(family.base(), study::Kept::table, study::Way::driven);
    return;
  }
  // The angles, and for every piston its pressure and what that is made of; of two threads.
  const Operation& operation = family.base().operation;
  const double numbers = 1 + 4.0 * family.base().pump.geometry.pistons;
  study::require_memory(
      2 * numbers * sizeof(double) * operation.samples_per_revolution,
      fmt::format("[operation] samples_per_revolution = {}", operation.samples_per_revolution),
      "lower samples_per_revolution");
}

Evaluator::Evaluator(Family family, std::vector<Output> outputs, study::Model model)
    : implementation_(
          std::make_unique<Implementation>(std::move(family), std::move(outputs), model)) {}
Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;

const Family& Evaluator::family() const { return implementation_->family; }
const std::vector<Output>& Evaluator::outputs() const { return implementation_->outputs; }
study::Model Evaluator::model() const { return implementation_->model; }
bool Evaluator::fast() const { return implementation_->kernel.has_value(); }

Evaluation Evaluator::evaluate(std::span<const double> values) const {
  Evaluation result;
  result.values.resize(outputs().size());
  evaluate(1, values, result.values, {&result.reason, 1});
  return result;
}

std::vector<double> Evaluator::outputs_at(std::span<const double> values) const {
  std::vector<double> results(outputs().size());
  auto scratch = implementation_->scratches.take([&] { return implementation_->fresh(); });
  family().make(values, scratch->the_case);
  implementation_->find(*scratch, results);
  implementation_->scratches.give_back(std::move(scratch));
  return results;
}

void Evaluator::evaluate(std::size_t count, std::span<const double> values,
                         std::span<double> results, std::span<std::string> reasons) const {
  const std::size_t n = family().variables().size(), m = outputs().size();
  auto scratch = implementation_->scratches.take([&] { return implementation_->fresh(); });
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = results.subspan(i * m, m);
    reasons[i] = study::reason_of([&] {
      family().make(values.subspan(i * n, n), scratch->the_case);
      implementation_->find(*scratch, to);
    });
    if (!reasons[i].empty()) std::fill(to.begin(), to.end(), not_computed());
  }
  implementation_->scratches.give_back(std::move(scratch));
}

}  // namespace bentaxis::designs

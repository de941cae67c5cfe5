#include "bentaxis/designs/evaluator.h"

#include <algorithm>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::designs {

struct Evaluator::Implementation {
  Family family;
  std::vector<Output> outputs;
  study::Model model;

  // Of a case that is valid.
  std::vector<double> general(const Case& the_case) const {
    return outputs_of(outputs, study::prepare(the_case), model);
  }
};

Evaluator::Evaluator(Family family, std::vector<Output> outputs, study::Model model)
    : implementation_(std::make_unique<Implementation>(
          Implementation{std::move(family), std::move(outputs), model})) {}
Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;

const Family& Evaluator::family() const { return implementation_->family; }
const std::vector<Output>& Evaluator::outputs() const { return implementation_->outputs; }
study::Model Evaluator::model() const { return implementation_->model; }
bool Evaluator::fast() const { return false; }

Evaluation Evaluator::evaluate(std::span<const double> values) const {
  Evaluation result;
  result.values.resize(outputs().size());
  evaluate(1, values, result.values, {&result.reason, 1});
  return result;
}

void Evaluator::evaluate(std::size_t count, std::span<const double> values,
                         std::span<double> results, std::span<std::string> reasons) const {
  const std::size_t n = family().variables().size(), m = outputs().size();
  Case scratch = family().base();
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = results.subspan(i * m, m);
    try {
      family().make(values.subspan(i * n, n), scratch);
      const std::vector<double> found = implementation_->general(scratch);
      std::copy(found.begin(), found.end(), to.begin());
      reasons[i].clear();
    } catch (const InputError& error) {
      reasons[i] = error.what();
    } catch (const ComputationError& error) {
      reasons[i] = error.what();
    }
    if (!reasons[i].empty()) std::fill(to.begin(), to.end(), not_computed());
  }
}

}  // namespace bentaxis::designs

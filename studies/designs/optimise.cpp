#include "bentaxis/designs/optimise.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "bentaxis/designs/pareto.h"
#include "bentaxis/files/csv_rows.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/number.h"
#include "optimise_pieces.h"

namespace bentaxis::designs {

struct Optimiser::Implementation : DesignProblem {
  using DesignProblem::DesignProblem;
};

Optimiser::Optimiser(Case base, OptimisePlan plan)
    : implementation_(std::make_unique<Implementation>(std::move(base), std::move(plan))) {}
Optimiser::~Optimiser() = default;
Optimiser::Optimiser(Optimiser&&) noexcept = default;

const OptimisePlan& Optimiser::plan() const { return implementation_->plan; }

std::size_t Optimiser::batches() const {
  return plan().search.restarts * (plan().search.generations + 1);
}

SweepRecord Optimiser::record(const std::string& program) const {
  const Implementation& it = *implementation_;
  SweepRecord record = record_of(Sweep(it.base, it.plan.designs), program);
  std::string all =
      record.identity + "\noptimise " + search_libraries() +
      fmt::format("\n{} {} {} {}", it.plan.search.population, it.plan.search.generations,
                  it.plan.search.restarts, it.plan.search.seed);
  if (it.plan.robust()) all += fmt::format("\nsamples {}", it.plan.samples);
  for (std::size_t k = 0; k < it.plan.designs.outputs.size(); ++k)
    all += fmt::format("\n{}", it.plan.designs.direction[k]);
  for (const Constraint& c : it.plan.constraints) all += "\n" + it.plan.text(c);
  for (const DutyCycle::Row& row : it.plan.conditions.rows) {
    all += "\n" + number_text(row.share);
    for (std::size_t k = 0; k < row.values.size(); ++k)
      all += " " + it.plan.conditions.variables[k].name() + " " + number_text(row.values[k]);
  }
  const std::string identity = sha256_of(all);
  record.plan.replace(record.plan.find(record.identity), record.identity.size(), identity);
  record.identity = identity;
  record.layout = {it.plan.evaluations(), it.plan.search.population, it.variables.size(),
                   it.rows() * it.computed(), true};
  return record;
}

Optimisation Optimiser::run(const OptimiseWork& work, const Progress& progress) const {
  return run_search(*implementation_, work, progress);
}

Case case_of(const Optimisation& found, std::size_t design) {
  std::vector<Variable> variables;
  for (const Varied& varied : found.plan.designs.varied) variables.push_back(varied.variable);
  const std::size_t n = variables.size();
  Case chosen = found.designs.base;
  Family(found.designs.base, std::move(variables))
      .make(std::span<const double>(found.designs.values).subspan(design * n, n), chosen);
  return chosen;
}

namespace {

// The designs that are wanted, with what was measured of them.
std::string designs_csv(const Optimisation& found, const std::vector<std::size_t>& wanted) {
  const std::size_t n = found.plan.designs.varied.size(), m = found.plan.designs.outputs.size();
  std::vector<std::string> header = {"design"};
  for (const Varied& varied : found.plan.designs.varied) header.push_back(varied.variable.name());
  for (const Output& o : found.plan.designs.outputs) header.push_back(o.name);
  header.emplace_back("violation");
  header.emplace_back("reason");
  CsvRows csv;
  csv.row(header);
  std::vector<std::string> reasons(found.evaluated());
  for (const auto& [design, reason] : found.designs.infeasible) reasons[design] = reason;
  for (const std::size_t design : wanted) {
    std::vector<std::string> values;
    for (std::size_t k = 0; k < n; ++k)
      values.push_back(
          found.plan.designs.varied[k].variable.text(found.designs.values[design * n + k]));
    const auto first = found.measured.begin() + static_cast<std::ptrdiff_t>(design * m);
    const double wrong = found.violations[design];
    csv.row(design, values, std::vector<double>(first, first + static_cast<std::ptrdiff_t>(m)),
            std::isfinite(wrong) ? wrong : not_computed(), reasons[design]);
  }
  return std::move(csv).text();
}

}  // namespace

std::string evaluations_csv(const Optimisation& found) {
  std::vector<std::size_t> all(found.evaluated());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return designs_csv(found, all);
}

std::string front_csv(const Optimisation& found) {
  return designs_csv(found, pareto_front(found.designs.results, found.plan.designs.direction));
}

}  // namespace bentaxis::designs

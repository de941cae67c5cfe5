#include "search_module.h"

#include <algorithm>
#include <cmath>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/gaco.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/batch_evaluators/member_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/hypervolume.hpp>
#include <utility>

namespace {

using bentaxis::designs::Evolution;

// An evolution as pagmo wants a problem.
class Problem {
 public:
  Problem() = default;  // pagmo makes one before it copies
  explicit Problem(const Evolution& evolution) : evolution_(&evolution) {}

  std::vector<double> fitness(const std::vector<double>& x) const { return evolution_->costs(x); }
  std::vector<double> batch_fitness(const std::vector<double>& points) const {
    return evolution_->costs(points);
  }
  std::pair<std::vector<double>, std::vector<double>> get_bounds() const {
    return {evolution_->low, evolution_->high};
  }
  std::size_t get_nobj() const { return evolution_->objectives; }
  std::size_t get_nix() const { return evolution_->whole; }
  template <class Archive>
  void serialize(Archive& /*archive*/, unsigned /*version*/) {}  // never kept

 private:
  const Evolution* evolution_ = nullptr;
};

}  // namespace

void bentaxis_evolve(const Evolution& evolution) {
  const std::size_t n = evolution.low.size(), size = evolution.first.size() / n;
  const pagmo::problem problem{Problem(evolution)};
  pagmo::population population(problem, 0, evolution.seed);
  const std::vector<double> costs = evolution.costs(evolution.first);
  const auto row = [](const std::vector<double>& of, std::size_t i, std::size_t width) {
    const auto first = of.begin() + static_cast<std::ptrdiff_t>(i * width);
    return std::vector<double>(first, first + static_cast<std::ptrdiff_t>(width));
  };
  for (std::size_t i = 0; i < size; ++i)
    population.push_back(row(evolution.first, i, n), row(costs, i, evolution.objectives));
  if (evolution.generations == 0) return;
  const pagmo::bfe batches{pagmo::member_bfe{}};
  if (evolution.objectives > 1) {
    pagmo::nsga2 nsga(evolution.generations, 0.95, 10, 1 / static_cast<double>(n), 50,
                      evolution.seed);
    nsga.set_bfe(batches);
    pagmo::algorithm(nsga).evolve(population);
  } else {
    pagmo::gaco ants(evolution.generations, static_cast<unsigned>(std::min<std::size_t>(size, 63)));
    ants.set_seed(evolution.seed);
    ants.set_bfe(batches);
    pagmo::algorithm(ants).evolve(population);
  }
}

double bentaxis_hypervolume(const std::vector<std::vector<double>>& points,
                            const std::vector<double>& reference) {
  return pagmo::hypervolume(points, true).compute(reference);
}

#include "bentaxis/designs/pareto.h"

#include <algorithm>

#include "bentaxis/pump/number.h"

namespace bentaxis::designs {

std::vector<std::size_t> pareto_front(std::span<const double> results,
                                      std::span<const int> direction) {
  // What it costs to choose a design: the smaller the better, in every output that matters.
  struct Competitor {
    std::size_t design;
    std::vector<double> costs;
  };
  std::vector<Competitor> candidates;
  for (std::size_t i = 0; (i + 1) * direction.size() <= results.size(); ++i) {
    Competitor candidate{i, {}};
    const auto row = results.subspan(i * direction.size(), direction.size());
    for (std::size_t k = 0; k < direction.size(); ++k)
      if (direction[k] != 0) candidate.costs.push_back(direction[k] < 0 ? row[k] : -row[k]);
    if (!candidate.costs.empty() &&
        std::all_of(candidate.costs.begin(), candidate.costs.end(), is_computed))
      candidates.push_back(std::move(candidate));
  }
  // In this order nobody is beaten by who comes later.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Competitor& a, const Competitor& b) { return a.costs < b.costs; });
  const auto beats = [](const Competitor& a, const Competitor& b) {
    bool better = false;
    for (std::size_t k = 0; k < a.costs.size(); ++k) {
      if (a.costs[k] > b.costs[k]) return false;
      better = better || a.costs[k] < b.costs[k];
    }
    return better;
  };
  std::vector<Competitor> front;
  for (Competitor& candidate : candidates) {
    // Of two outputs only who was best in the second so far can beat: who was found last.
    if (candidate.costs.size() == 2 && !front.empty()) {
      if (!beats(front.back(), candidate)) front.push_back(std::move(candidate));
      continue;
    }
    // Who was found last is the likeliest to beat.
    if (std::none_of(front.rbegin(), front.rend(),
                     [&](const Competitor& other) { return beats(other, candidate); }))
      front.push_back(std::move(candidate));
  }
  std::vector<std::size_t> designs;
  for (const Competitor& candidate : front) designs.push_back(candidate.design);
  std::sort(designs.begin(), designs.end());
  return designs;
}

}  // namespace bentaxis::designs

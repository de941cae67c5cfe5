#include "mapping_match.h"

#include <algorithm>
#include <cmath>

namespace bentaxis::study::mapping {
namespace {

// Another unit than the one that a column's name says is thought of beyond this factor.
constexpr double kWrongUnit = 1.5;
// Units that are tried where none is said: far enough apart that no error of a model leads from one
// to the next.
constexpr std::array<const char*, 14> kGuessedUnits = {
    "N", "kN", "MN", "lbf", "Nm", "kNm", "Nmm", "lbf in", "m", "mm", "um", "bar", "MPa", "Pa"};

}  // namespace

std::string unit_for(double fit, const std::string& ours, double unit_in_si,
                     const std::string& said) {
  const auto distance = [&](const std::string& name) {
    return std::abs(std::log(std::abs(fit) * compare::find_unit(name)->si / unit_in_si));
  };
  const auto* known = compare::find_unit(said);
  if (known != nullptr && known->family == ours && distance(said) < std::log(kWrongUnit))
    return said;
  std::string best;
  for (const char* name : kGuessedUnits)
    if (compare::find_unit(name)->family == ours &&
        (best.empty() || distance(name) < distance(best)))
      best = name;
  if (known != nullptr && known->family == ours && distance(best) > std::log(kWrongUnit))
    return said;
  return best;
}

Match match_of(double square, double product, double own, const std::string& ours,
               double unit_in_si, const std::string& said, int wanted) {
  Match m;
  if (own <= 0 || product == 0) return m;
  m.sign = wanted != 0 ? wanted : product < 0 ? -1 : 1;
  m.unit = unit_for(product / own, ours, unit_in_si, said);
  if (m.unit.empty()) return m;
  const double factor = m.sign * unit_in_si / compare::find_unit(m.unit)->si;
  m.cost = std::sqrt(std::max(0.0, square - 2 * factor * product + factor * factor * own) / square);
  return m;
}

void add_component(const Products& p, const Axes& axes, std::size_t j, double& product,
                   double& own) {
  for (std::size_t i = 0; i < 3; ++i) {
    product += axes[j][i] * p.theirs_ours[j][i];
    for (std::size_t k = 0; k < 3; ++k) own += axes[j][i] * axes[j][k] * p.ours_ours[i][k];
  }
}

double cost_without_signs(const Products& p, const Axes& axes, double factor) {
  double difference = 0, square = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    if (!p.theirs_theirs[j]) continue;
    double product = 0, own = 0;
    add_component(p, axes, j, product, own);
    difference += *p.theirs_theirs[j] - 2 * factor * std::abs(product) + factor * factor * own;
    square += *p.theirs_theirs[j];
  }
  return std::sqrt(std::max(0.0, difference) / square);
}

double cost_of_mixed(const Products& p, const Axes& axes, double factor) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  double least = std::numeric_limits<double>::max();
  do {
    const Axes ordered = {axes[order[0]], axes[order[1]], axes[order[2]]};
    least = std::min(least, cost_without_signs(p, ordered, factor));
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

}  // namespace bentaxis::study::mapping

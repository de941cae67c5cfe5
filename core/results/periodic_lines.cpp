#include "bentaxis/results/periodic_lines.h"

#include <algorithm>
#include <utility>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {

std::vector<double> on_lines(const std::vector<double>& theta_deg,
                             const std::vector<double>& values,
                             const std::vector<double>& wanted_deg) {
  std::vector<std::pair<double, double>> points;  // angle in the turn, value
  for (std::size_t i = 0; i < theta_deg.size(); ++i)
    if (is_computed(values[i])) points.emplace_back(wrap_degrees(theta_deg[i]), values[i]);
  std::sort(points.begin(), points.end());
  std::vector<double> found(wanted_deg.size(), not_computed());
  if (points.empty()) return found;
  for (std::size_t i = 0; i < wanted_deg.size(); ++i) {
    const double angle = wrap_degrees(wanted_deg[i]);
    const auto above =
        std::upper_bound(points.begin(), points.end(), angle,
                         [](double at, const auto& point) { return at < point.first; });
    const auto& [from, first] = above == points.begin() ? points.back() : *(above - 1);
    const auto& [to, next] = above == points.end() ? points.front() : *above;
    const double past = wrap_degrees(angle - from), step = wrap_degrees(to - from);
    found[i] = step > 0 ? first + past / step * (next - first) : first;
  }
  return found;
}

}  // namespace bentaxis

#include "mapping_curves.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bentaxis::study::mapping {

double dot(const Series& a, const Series& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Series centred(Series values) {
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

Series normalised(const Series& values) {
  const double size = std::sqrt(dot(values, values));
  Series out = centred(values);
  const double length = std::sqrt(dot(out, out));
  for (double& value : out) value = length > 1e-9 * size ? value / length : 0;
  return out;
}

Series length_of(const std::array<Series, 3>& vector) {
  Series out(std::max({vector[0].size(), vector[1].size(), vector[2].size()}), 0);
  for (const auto& component : vector)
    for (std::size_t i = 0; i < component.size(); ++i) out[i] += component[i] * component[i];
  for (double& value : out) value = std::sqrt(value);
  return out;
}

Series coarse(const Series& fine) {
  Series out;
  for (std::size_t i = 0; i < kCoarse; ++i) out.push_back(fine[i * fine.size() / kCoarse]);
  return out;
}

double shifted_product(const Series& ours, const Series& theirs, std::size_t shift) {
  double r = 0;
  for (std::size_t i = 0; i < shift; ++i) r += ours[i] * theirs[i + kCoarse - shift];
  for (std::size_t i = shift; i < kCoarse; ++i) r += ours[i] * theirs[i - shift];
  return r;
}

double roundest(const std::function<double(const std::vector<double>&)>& cost,
                std::vector<double>& angles) {
  constexpr double kAsGood = 0.2;  // of the logarithm of the mean square difference
  const double least = cost(angles);
  for (const double step : {90.0, 45.0, 30.0, 10.0, 5.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.01, 0.005,
                            1e-3, 1e-4, 1e-5, 1e-6}) {
    std::vector<double> round = angles;
    // Divided where the step is a fraction: 17.3 is 173 / 10, and 173 x 0.1 is another number.
    const double per_degree = std::round(1 / step);
    for (double& angle : round)
      angle = step < 1 ? std::round(angle / step) / per_degree : std::round(angle / step) * step;
    const bool near = std::equal(round.begin(), round.end(), angles.begin(),
                                 [](double a, double b) { return std::abs(a - b) < 2; });
    if (!near || cost(round) > least + kAsGood) continue;
    angles = round;
    return step;
  }
  return 0;
}

bool is_constant(const Series& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low <= 1e-9 * std::max(std::abs(*low), std::abs(*high));
}

}  // namespace bentaxis::study::mapping

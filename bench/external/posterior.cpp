// Densities with known moments through the sampler of identification.
#include "bentaxis/designs/posterior.h"

#include <array>
#include <cmath>

#include "numbers.h"

namespace bentaxis::external {
namespace {

using designs::SampledDensity;

SampledDensity density(std::size_t parameters, std::size_t residuals, double bound) {
  SampledDensity of;
  of.problem.parameters = parameters;
  of.problem.residuals = residuals;
  of.problem.low.assign(parameters, -bound);
  of.problem.high.assign(parameters, bound);
  return of;
}

struct Moments {
  std::vector<double> mean, variance;
};

// As identify does: from the least residuals that are found from a start.
Moments moments(const SampledDensity& of, const std::vector<double>& start, std::size_t steps,
                std::vector<double> (*shown)(std::span<const double>)) {
  const designs::LeastSquaresFit fit = designs::least_squares(of.problem, start);
  constexpr std::size_t kDraws = 200000;
  const designs::Draws draws =
      designs::draws_of(of, fit, {.seed = 1, .steps = steps, .draws = kDraws});
  Moments m;
  const auto count = static_cast<double>(draws.count);
  for (std::size_t d = 0; d < draws.count; ++d) {
    const std::vector<double> values =
        shown(std::span(draws.unknowns).subspan(d * of.problem.parameters, of.problem.parameters));
    m.mean.resize(values.size());
    m.variance.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      m.mean[i] += values[i] / count;
      m.variance[i] += values[i] * values[i] / count;
    }
  }
  for (std::size_t i = 0; i < m.mean.size(); ++i) m.variance[i] -= m.mean[i] * m.mean[i];
  return m;
}

std::vector<double> themselves(std::span<const double> x) { return {x.begin(), x.end()}; }

// mu ~ N(0, 5), tau ~ half Cauchy(5), eta_j ~ N(0, 1), y_j ~ N(mu + tau eta_j, sigma_j).
void put_eight_schools(Numbers& numbers) {
  constexpr std::size_t kSchools = 8;
  SampledDensity of = density(2 + kSchools, 2 + 2 * kSchools, 100);
  of.problem.low[1] = 0;
  of.problem.high[1] = 1000;
  of.problem.evaluate = [](std::span<const double> x, std::span<double> r) {
    constexpr double kEffect[kSchools] = {28, 8, -3, 7, -1, 1, 18, 12};
    constexpr double kDeviation[kSchools] = {15, 10, 16, 11, 9, 11, 10, 18};
    r[0] = x[0] / 5;
    r[1] = std::sqrt(2 * std::log1p(x[1] * x[1] / 25));
    for (std::size_t j = 0; j < kSchools; ++j) {
      r[2 + j] = x[2 + j];
      r[2 + kSchools + j] = (kEffect[j] - x[0] - x[1] * x[2 + j]) / kDeviation[j];
    }
    return true;
  };
  std::vector<double> start(2 + kSchools, 0.1);
  const Moments m = moments(of, start, 20000, themselves);
  numbers.push_back({"posterior.eight_schools.mu", m.mean[0]});
  numbers.push_back({"posterior.eight_schools.tau", m.mean[1]});
  numbers.push_back({"posterior.eight_schools.mu.exact", m.mean[0]});
  numbers.push_back({"posterior.eight_schools.tau.exact", m.mean[1]});
}

// x1 ~ N(0, 100), x2 + b x1^2 - 100 b ~ N(0, 1) with b = 0.03 (variances).
void put_banana(Numbers& numbers) {
  SampledDensity of = density(2, 2, 1000);
  of.problem.evaluate = [](std::span<const double> x, std::span<double> r) {
    r[0] = x[0] / 10;
    r[1] = x[1] + 0.03 * x[0] * x[0] - 3;
    return true;
  };
  const Moments m = moments(of, {1, 1}, 20000, themselves);
  for (const std::size_t i : {0U, 1U}) {
    const std::string x = "posterior.banana.x" + std::to_string(i + 1);
    numbers.push_back({x + ".mean", m.mean[i]});
    numbers.push_back({x + ".variance", m.variance[i]});
  }
}

// 0.3 N((-3, 0), 1) + 0.7 N((3, 0), 1).
void put_bimodal(Numbers& numbers) {
  SampledDensity of = density(2, 2, 100);
  of.problem.evaluate = [](std::span<const double> x, std::span<double> r) {
    const auto lobe = [&](double share, double middle) {
      return std::log(share) - std::pow(x[0] - middle, 2) / 2;
    };
    const double left = lobe(0.3, -3), right = lobe(0.7, 3), higher = std::max(left, right);
    const double height = higher + std::log(std::exp(left - higher) + std::exp(right - higher));
    r[0] = std::sqrt(std::max(0.0, -2 * height));
    r[1] = x[1];
    return true;
  };
  const Moments m = moments(of, {1, 1}, 20000, [](std::span<const double> x) {
    return std::vector<double>{x[0], x[0] > 0 ? 1.0 : 0.0};
  });
  numbers.push_back({"posterior.bimodal.mean", m.mean[0]});
  numbers.push_back({"posterior.bimodal.variance", m.variance[0]});
  numbers.push_back({"posterior.bimodal.right", m.mean[1]});
}

}  // namespace

Numbers posterior() {
  Numbers numbers;
  put_eight_schools(numbers);
  put_banana(numbers);
  put_bimodal(numbers);
  return numbers;
}

}  // namespace bentaxis::external

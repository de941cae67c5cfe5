#include "bentaxis/designs/propagation.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "bentaxis/designs/points.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/reporting.h"
#include "plain_double.h"

namespace bentaxis::designs {
namespace {

constexpr double kConfidence = 0.95;  // of the intervals of estimates
constexpr std::size_t kPoints = 64;   // evaluated at a time
constexpr double kTail = (1 - kConfidence) / 2;

}  // namespace

QuantileRule::QuantileRule(double share, std::size_t samples) {
  const auto count = static_cast<double>(samples);
  // How many values lie below the quantile is binomial; Boost rounds outwards.
  const boost::math::binomial_distribution<double, PlainDouble> below(count, share);
  const auto first = static_cast<std::size_t>(boost::math::quantile(below, kTail));
  const auto last = static_cast<std::size_t>(boost::math::quantile(complement(below, kTail)));
  low_ = first;  // with at most that probability `first` values or fewer lie below
  high_ = std::min(last, samples - 1);
  const double place = share * (count - 1);
  below_ = std::min(static_cast<std::size_t>(place), samples - 2);
  part_ = place - static_cast<double>(below_);
}

std::size_t QuantileRule::fewest(double share) {
  const double tail = std::min(share, 1 - share);  // none lies beyond with at most that probability
  return static_cast<std::size_t>(std::ceil(std::log(kTail) / std::log1p(-tail)));
}

Estimate QuantileRule::operator()(const std::vector<double>& sorted) const {
  const double value = sorted[below_] + part_ * (sorted[below_ + 1] - sorted[below_]);
  return {value, sorted[low_], sorted[high_]};
}

std::size_t fewest_samples(double level) { return QuantileRule::fewest((1 - level) / 2); }

double deviation_known_to(std::size_t samples) {
  return 1 / std::sqrt(2 * static_cast<double>(samples - 1));
}

Spread spread_of(std::vector<double> values, double level) {
  const std::size_t samples = values.size();
  std::sort(values.begin(), values.end());
  Spread s;
  const auto count = static_cast<double>(samples);
  // From a value among them, so that equal ones leave no round-off.
  for (const double v : values) s.mean += (v - values.front()) / count;
  s.mean += values.front();
  double second = 0, fourth = 0;  // central moments
  for (const double v : values) {
    const double square = (v - s.mean) * (v - s.mean);
    second += square / (count - 1);
    fourth += square * square / count;
  }
  s.deviation = std::sqrt(second);
  s.mean_error = s.deviation / std::sqrt(count);
  if (second > 0)
    s.deviation_error =
        std::sqrt(std::max(0.0, fourth - second * second) / count) / (2 * s.deviation);
  const double tail = (1 - level) / 2;
  const auto quantile = [&](double share) {
    if (samples >= QuantileRule::fewest(share)) return QuantileRule(share, samples)(values);
    return Estimate{not_computed(), not_computed(), not_computed()};
  };
  s.low = quantile(tail);
  s.median = quantile(0.5);
  s.high = quantile(1 - tail);
  return s;
}

namespace {

struct Evaluated {
  std::vector<double> results;
  std::vector<std::string> reasons;
};

// Of few points, small blocks: each is told of when it is done. In whole vectors of the kernel.
std::size_t points_of_block(std::size_t count) {
  constexpr std::size_t kVector = 8, kReports = 64;
  const std::size_t vectors = std::max<std::size_t>(1, count / (kVector * kReports));
  return std::min(kPoints, vectors * kVector);
}

// Outputs of all points, in blocks, by threads.
Evaluated evaluate(const Response& response, std::size_t outputs, std::size_t dimension,
                   std::size_t count,
                   const std::function<void(std::size_t index, std::span<double> values)>& point,
                   int threads, const Progress& progress) {
  // Results twice, with and without the infeasible ones, and a reason each.
  const auto number = static_cast<double>(count);
  study::require_memory(
      number * (2 * static_cast<double>(outputs * sizeof(double)) + sizeof(std::string)),
      fmt::format("--samples: {} of {} each", counted(count, "design"), counted(outputs, "number")),
      "lower --samples, or ask for fewer outputs");
  Evaluated all{std::vector<double>(count * outputs), std::vector<std::string>(count)};
  const std::size_t points = points_of_block(count), blocks = (count + points - 1) / points;
  study::for_each_of(blocks, threads, progress, [&](std::size_t block) {
    const std::size_t from = block * points, here = std::min(points, count - from);
    std::vector<double> values(here * dimension);
    for (std::size_t i = 0; i < here; ++i)
      point(from + i, std::span(values).subspan(i * dimension, dimension));
    response(here, values, std::span(all.results).subspan(from * outputs, here * outputs),
             std::span(all.reasons).subspan(from, here));
  });
  return all;
}

}  // namespace

std::vector<double> SampledOutputs::of(std::size_t output) const {
  std::vector<double> column;
  for (std::size_t i = output; i < results.size(); i += outputs) column.push_back(results[i]);
  return column;
}

SampledOutputs sample(const Response& response, std::size_t outputs,
                      const UncertainVariables& numbers, std::size_t samples, std::uint64_t seed,
                      int threads, const Progress& progress) {
  const auto points = random(numbers.size(), samples, seed);
  const Evaluated all = evaluate(
      response, outputs, numbers.size(), samples,
      [&](std::size_t index, std::span<double> values) {
        std::vector<double> shares(numbers.size());
        points->point(index, shares);
        numbers.values(shares, values);
      },
      threads, progress);
  SampledOutputs found;
  found.outputs = outputs;
  for (std::size_t i = 0; i < samples; ++i) {
    if (!all.reasons[i].empty())
      found.infeasible.emplace_back(i, all.reasons[i]);
    else
      found.results.insert(found.results.end(), all.results.begin() + i * outputs,
                           all.results.begin() + (i + 1) * outputs);
  }
  return found;
}

FirstOrder first_order(const Response& response, std::size_t outputs,
                       const UncertainVariables& numbers) {
  const std::size_t n = numbers.size();
  std::vector<double> means(n);
  for (std::size_t i = 0; i < n; ++i) means[i] = numbers.distributions[i].mean();
  constexpr int kSteps = 4;  // up and down by a half, then a quarter, of the deviation
  constexpr double kStep[kSteps] = {0.5, -0.5, 0.25, -0.25};
  std::vector<double> points = means;
  for (std::size_t i = 0; i < n; ++i)
    for (const double step : kStep) {
      append(points, means);
      points[points.size() - n + i] += step * numbers.distributions[i].standard_deviation();
    }
  const std::size_t count = 1 + kSteps * n;
  std::vector<double> results(count * outputs);
  std::vector<std::string> reasons(count);
  response(count, points, results, reasons);

  FirstOrder found;
  for (const std::string& reason : reasons)
    if (!reason.empty()) add_once(found.reasons, reason);
  found.values.assign(results.begin(), results.begin() + outputs);
  const std::vector<double> covariances = numbers.covariances();
  for (std::size_t o = 0; o < outputs; ++o) {
    std::vector<double> c(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = [&](std::size_t step) {
        return results[(1 + kSteps * i + step) * outputs + o];
      };
      const double deviation = numbers.distributions[i].standard_deviation();
      const double coarse = (at(0) - at(1)) / deviation;
      const double fine = (at(2) - at(3)) / (0.5 * deviation);
      c[i] = fine + (fine - coarse) / 3;
      found.derivative_errors.push_back(std::abs(fine - coarse) / 3);
    }
    double variance = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (covariances[i * n + j] != 0) variance += c[i] * c[j] * covariances[i * n + j];
    append(found.derivatives, c);
    found.deviations.push_back(std::isnan(variance) ? not_computed()
                                                    : std::sqrt(std::max(0.0, variance)));
  }
  for (double& value : found.derivatives)
    if (std::isnan(value)) value = not_computed();
  for (double& value : found.derivative_errors)
    if (std::isnan(value)) value = not_computed();
  return found;
}

}  // namespace bentaxis::designs

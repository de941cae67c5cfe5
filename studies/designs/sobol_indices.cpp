#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "bentaxis/designs/points.h"
#include "bentaxis/designs/propagation.h"
#include "bentaxis/files/module.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/reporting.h"
#include "sobol_module.h"

namespace bentaxis::designs {
namespace {

constexpr double kConfidence = 0.95;
// Round-off of an output, in units of the last place of its largest value.
constexpr double kUnits = 16;
// Round-off of the estimator itself, of an index.
constexpr double kOfEstimator = 1e-12;
// An output whose round-off is this share of its standard deviation does not vary.
constexpr double kNoVariation = 1e-3;

#ifndef BENTAXIS_HAS_OPENTURNS
#define BENTAXIS_OPENTURNS_MODULE ""
#endif

// OpenTURNS brings eighty libraries, a BLAS of its own among them, and a tenth of a second.
const Module& module() {
  static const Module loaded(BENTAXIS_OPENTURNS_MODULE);
  return loaded;
}

auto& estimator() {
  return module().function<decltype(bentaxis_sobol_indices)>("bentaxis_sobol_indices", "--sobol");
}

void estimate(std::size_t base, std::size_t numbers, const std::vector<double>& inputs,
              const std::vector<double>& outputs, std::vector<double>& found) {
  std::array<char, 500> message{};
  if (estimator()(base, numbers, inputs.data(), outputs.data(), kConfidence, found.data(),
                  message.data(), message.size()) != 0)
    throw ComputationError(std::string("Sobol indices: OpenTURNS: ") + message.data());
}

// Points A, B, and A with column i of B, of base points one after the other: what estimators take,
// but base point by base point, so that each is computed as a whole.
class Design {
 public:
  Design(const UncertainVariables& numbers, std::size_t base, std::uint64_t seed)
      : numbers_(numbers), points_(sobol(2 * numbers.size(), base, seed)) {}

  std::size_t of_one() const { return numbers_.size() + 2; }
  // Points of one base point, of_one() x numbers.
  void points(std::size_t index, std::span<double> values) const {
    const std::size_t n = numbers_.size();
    std::vector<double> shares(2 * n);
    points_->point(index, shares);
    const auto a = values.subspan(0, n), b = values.subspan(n, n);
    numbers_.values(std::span(shares).subspan(0, n), a);
    numbers_.values(std::span(shares).subspan(n, n), b);
    for (std::size_t i = 0; i < n; ++i) {
      const auto mixed = values.subspan((2 + i) * n, n);
      std::copy(a.begin(), a.end(), mixed.begin());
      mixed[i] = b[i];
    }
  }

 private:
  const UncertainVariables& numbers_;
  std::unique_ptr<Points> points_;
};

// An index with its interval: what differs from 0 or 1 by round-off alone is 0 or 1.
Estimate estimate_of(const double* index, double round_off) {
  const auto rounded = [&](double value) {
    if (std::abs(value) <= round_off) return 0.0;
    return std::abs(value - 1) <= round_off ? 1.0 : value;
  };
  const double value = rounded(index[0]);
  return {value, std::min(rounded(index[1]), value), std::max(rounded(index[2]), value)};
}

// Takes the mean off values, which loses digits in the estimator's sums.
// @return round-off of an output over its standard deviation
double centre(std::vector<double>& values) {
  double mean = 0, largest = 0, squares = 0;
  for (const double v : values) {
    mean += (v - values.front()) / static_cast<double>(values.size());
    largest = std::max(largest, std::abs(v));
  }
  mean += values.front();
  for (double& v : values) {
    v -= mean;
    squares += v * v / static_cast<double>(values.size());
  }
  if (!(squares > 0)) return HUGE_VAL;
  return kUnits * std::numeric_limits<double>::epsilon() * largest / std::sqrt(squares);
}

}  // namespace

void require_sobol_indices() {
#ifdef BENTAXIS_HAS_OPENTURNS
  estimator();
#else
  throw InputError(
      "--sobol: this program was built without OpenTURNS; install libopenturns-dev (scripts/setup "
      "full) and build again");
#endif
}

std::string openturns_version() {
#ifdef BENTAXIS_HAS_OPENTURNS
  return BENTAXIS_HAS_OPENTURNS;
#else
  return "none";
#endif
}

SobolIndices sobol_indices(const Response& response, std::size_t outputs,
                           const UncertainVariables& numbers, std::size_t base, std::uint64_t seed,
                           int threads, const Progress& progress) {
  if (!numbers.independent())
    throw InputError("Sobol indices: need independent parameters: [uncertainty] correlates some");
  require_sobol_indices();
  const std::size_t n = numbers.size();
  const Design design(numbers, base, seed);
  const std::size_t rows = design.of_one();
  std::vector<double> inputs(base * rows * n), results(base * rows * outputs);
  std::vector<std::string> reasons(base * rows);
  study::for_each_of(base, threads, progress, [&](std::size_t i) {
    const auto values = std::span(inputs).subspan(i * rows * n, rows * n);
    design.points(i, values);
    response(rows, values, std::span(results).subspan(i * rows * outputs, rows * outputs),
             std::span(reasons).subspan(i * rows, rows));
  });

  std::vector<std::size_t> kept;  // base points all of whose points have outputs
  for (std::size_t i = 0; i < base; ++i)
    if (std::all_of(reasons.begin() + i * rows, reasons.begin() + (i + 1) * rows,
                    [](const std::string& reason) { return reason.empty(); }))
      kept.push_back(i);
  SobolIndices all;
  all.evaluations = base * rows;
  all.left_out = base - kept.size();
  if (kept.size() < kFewestBasePoints)
    throw ComputationError("Sobol indices: only " + std::to_string(kept.size()) + " of " +
                           std::to_string(base) + " base points have outputs at all their points");
  std::vector<double> ordered(kept.size() * rows * n), column(kept.size() * rows);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t k = 0; k < kept.size(); ++k)
      std::copy_n(inputs.begin() + (kept[k] * rows + r) * n, n,
                  ordered.begin() + (r * kept.size() + k) * n);
  for (std::size_t o = 0; o < outputs; ++o) {
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t k = 0; k < kept.size(); ++k)
        column[r * kept.size() + k] = results[(kept[k] * rows + r) * outputs + o];
    std::vector<double> found(6 * n, not_computed());
    const double noise = is_computed(column.front()) ? centre(column) : HUGE_VAL;
    if (noise < kNoVariation) estimate(kept.size(), n, ordered, column, found);
    const double round_off = std::max(kOfEstimator, noise);
    if (n == 1 && is_computed(found[0])) {
      // All of the variance is of the one: no estimate, whose interval would mean nothing.
      all.first.push_back({1, 1, 1});
      all.total.push_back({1, 1, 1});
      continue;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double* const row = found.data() + 6 * i;
      all.first.push_back(is_computed(row[0]) ? estimate_of(row, round_off)
                                              : Estimate{row[0], row[1], row[2]});
      all.total.push_back(is_computed(row[3]) ? estimate_of(row + 3, round_off)
                                              : Estimate{row[3], row[4], row[5]});
    }
  }
  return all;
}

}  // namespace bentaxis::designs

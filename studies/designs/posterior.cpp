#include "bentaxis/designs/posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/reporting.h"
#include "moments.h"

namespace bentaxis::designs {
namespace {

using Vector = std::vector<double>;

// Random numbers that are the same everywhere.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(seed * 0x9e3779b97f4a7c15U + stream) {
    engine_.discard(8);
  }
  double uniform() { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1p-53; }
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }
  double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform()); }

 private:
  std::mt19937_64 engine_;
};

// The density in the sampler's coordinates.
class Density {
 public:
  explicit Density(const SampledDensity& of) : of_(of), coordinates_(of.coordinates) {
    coordinates_.resize(of.problem.parameters, kOwnCoordinate);
  }

  Vector inner(std::span<const double> x) const {
    Vector y(x.begin(), x.end());
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = coordinates_[i].inner(x[i]);
    return y;
  }
  Vector outer(const Vector& y) const {
    Vector x = y;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = coordinates_[i].outer(y[i]);
    return x;
  }
  /// Logarithm of the density of y, but for a constant.
  double operator()(const Vector& y) const {
    const LeastSquaresProblem& problem = of_.problem;
    const Vector x = outer(y);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(x[i] >= problem.low[i] && x[i] <= problem.high[i])) return -HUGE_VAL;
      sum += coordinates_[i].stretch(x[i]);
      if (of_.log_factor) sum += of_.log_factor(i, x[i]);
    }
    Vector residuals(problem.residuals);
    if (!problem.evaluate(x, residuals)) return -HUGE_VAL;
    for (const double r : residuals) sum -= r * r / 2;
    return sum;
  }

 private:
  const SampledDensity& of_;
  std::vector<SamplerCoordinate> coordinates_;  // by unknown
};

// A place that data with errors of their own, and any start, could have led to: where the data
// leave a direction open such places lie all along it.
Vector scattered(const SampledDensity& density, const LeastSquaresFit& fit, Random& random) {
  const LeastSquaresProblem& whole = density.problem;
  Vector noise(whole.residuals);
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = density.noisy.empty() || density.noisy[i] != 0 ? random.normal() : 0;
  LeastSquaresProblem problem = whole;
  problem.evaluate = [&](std::span<const double> x, std::span<double> residuals) {
    if (!whole.evaluate(x, residuals)) return false;
    for (std::size_t i = 0; i < noise.size(); ++i) residuals[i] += noise[i];
    return true;
  };
  const LeastSquaresOptions rough{.most_iterations = 15, .enough = 0.1};
  double share = 1;
  for (int attempt = 0; attempt < 4; ++attempt, share /= 3) {
    Vector start(fit.x);
    for (std::size_t i = 0; i < start.size(); ++i)
      start[i] +=
          share * (whole.low[i] + random.uniform() * (whole.high[i] - whole.low[i]) - start[i]);
    try {
      const LeastSquaresFit found = least_squares(problem, start, rough);
      Vector residuals(whole.residuals);
      if (!whole.evaluate(found.x, residuals)) continue;
      // Far above the fit it is another valley, or the way down was not finished.
      if (sum_of_squares(residuals) <
          fit.sum_of_squares + 3 * static_cast<double>(whole.parameters))
        return found.x;
    } catch (const ComputationError&) {
      continue;
    }
  }
  return fit.x;
}

// Moves of a half of the walkers depend on the other half alone.
class Ensemble {
 public:
  Ensemble(const SampledDensity& density, const LeastSquaresFit& fit, std::uint64_t seed,
           std::size_t number)
      : density_(density), parameters_(density.problem.parameters) {
    const std::size_t count = std::max<std::size_t>(32, 3 * parameters_ + parameters_ % 2);
    for (std::size_t w = 0; w < count; ++w) random_.emplace_back(seed, number * count + w);
    places_.resize(count);
    heights_.resize(count);
    for (std::size_t w = 0; w < count; ++w) {
      places_[w] = density_.inner(scattered(density, fit, random_[w]));
      // Two at one place would stay on a line.
      for (double& y : places_[w]) y *= 1 + 1e-9 * random_[w].normal();
      heights_[w] = density_(places_[w]);
      if (heights_[w] == -HUGE_VAL) {
        places_[w] = density_.inner(fit.x);
        heights_[w] = density_(places_[w]);
      }
    }
  }

  void step() {
    const std::size_t half = places_.size() / 2;
    for (const std::size_t from : {std::size_t{0}, half})
      for (std::size_t k = 0; k < half; ++k) accepted_ += move(from + k, half - from, half);
    ++steps_;
  }

  std::vector<Vector> places() const {
    std::vector<Vector> all;
    for (const Vector& y : places_) all.push_back(density_.outer(y));
    return all;
  }
  double accepted() const {
    return static_cast<double>(accepted_) / static_cast<double>(steps_ * places_.size());
  }

 private:
  bool move(std::size_t w, std::size_t others, std::size_t half) {
    Random& random = random_[w];
    const auto dimension = static_cast<double>(parameters_);
    Vector y = places_[w];
    double weight = 0;
    if (random.uniform() < 0.5) {
      const Vector& about = places_[others + random.below(half)];
      const double root = 1 + random.uniform();  // z = root^2 / 2: density 1 / sqrt(z) on 1/2 .. 2
      const double z = root * root / 2;
      for (std::size_t i = 0; i < parameters_; ++i) y[i] = about[i] + z * (y[i] - about[i]);
      weight = (dimension - 1) * std::log(z);
    } else {
      const std::size_t a = random.below(half), b = (a + 1 + random.below(half - 1)) % half;
      const bool whole = random.uniform() < 0.1;  // from one mode to another
      const double factor =
          (whole ? 1 : 2.38 / std::sqrt(2 * dimension)) * (1 + 0.02 * random.normal());
      for (std::size_t i = 0; i < parameters_; ++i)
        y[i] += factor * (places_[others + a][i] - places_[others + b][i]);
    }
    const double height = density_(y);
    if (!(std::log(random.uniform()) < weight + height - heights_[w])) return false;
    places_[w] = std::move(y);
    heights_[w] = height;
    return true;
  }

  Density density_;
  std::size_t parameters_, accepted_ = 0, steps_ = 0;
  std::vector<Random> random_;
  std::vector<Vector> places_;
  Vector heights_;
};

// chain[step][walker][unknown] of the kept half of the steps.
using Chain = std::vector<std::vector<Vector>>;

// Root of the ratio of the variance of all to that within the halves of each walker's chain.
double rhat_of(const Chain& chain, std::size_t unknown) {
  const std::size_t half = chain.size() / 2;
  Vector means;
  double within = 0;
  for (std::size_t w = 0; w < chain[0].size(); ++w)
    for (const std::size_t from : {std::size_t{0}, half}) {
      Vector values;
      for (std::size_t s = from; s < from + half; ++s) values.push_back(chain[s][w][unknown]);
      const Moments m = moments_of(values);
      means.push_back(m.mean);
      within += m.variance;
    }
  within /= static_cast<double>(means.size());
  const double between = moments_of(means).variance;
  const auto count = static_cast<double>(half);
  return within > 0 ? std::sqrt((count - 1) / count + between / within) : HUGE_VAL;
}

// Steps after which the mean of a walker's unknown is forgotten (Sokal's window, of the mean
// autocorrelation over the walkers).
double correlation_steps(const Chain& chain, std::size_t unknown) {
  const std::size_t steps = chain.size(), walkers = chain[0].size();
  Vector all;
  for (const auto& step : chain)
    for (const Vector& place : step) all.push_back(place[unknown]);
  const Moments whole = moments_of(all);
  for (double& value : all) value -= whole.mean;
  double sum = 1;
  for (std::size_t lag = 1; lag < steps / 2; ++lag) {
    double product = 0;
    for (std::size_t i = 0, later = lag * walkers; later < all.size(); ++i, ++later)
      product += all[i] * all[later];
    product /= static_cast<double>((steps - lag) * walkers) * whole.variance;
    sum += 2 * product;
    if (static_cast<double>(lag) > 5 * sum) break;
  }
  return std::max(sum, 1.0);
}

}  // namespace

const SamplerCoordinate kOwnCoordinate = {[](double x) { return x; }, [](double y) { return y; },
                                          [](double) { return 0.0; }};
const SamplerCoordinate kLogarithmicCoordinate = {[](double x) { return std::log(x); },
                                                  [](double y) { return std::exp(y); },
                                                  [](double x) { return std::log(x); }};

Draws draws_of(const SampledDensity& density, const LeastSquaresFit& fit,
               const SamplerOptions& options, const Progress& progress) {
  const std::size_t parameters = density.problem.parameters;
  constexpr std::size_t kEnsembles = 2;  // that know nothing of each other: R-hat compares them too
  const std::size_t steps = options.steps, kept = steps / 2;
  std::vector<Chain> parts(kEnsembles);
  std::vector<double> accepted(kEnsembles);
  study::Reporting reporting(kEnsembles * steps, progress);
  numerics::parallel_for(options.threads, kEnsembles, [&](std::size_t e) {
    Ensemble ensemble(density, fit, options.seed, e);
    for (std::size_t s = 0; s < steps; ++s) {
      ensemble.step();
      if (s >= steps - kept) parts[e].push_back(ensemble.places());
      reporting.done();
    }
    accepted[e] = ensemble.accepted();
  });
  Chain chain = std::move(parts[0]);
  for (std::size_t s = 0; s < kept; ++s)
    for (std::size_t e = 1; e < kEnsembles; ++e)
      chain[s].insert(chain[s].end(), parts[e][s].begin(), parts[e][s].end());
  const std::size_t walkers = chain[0].size();
  Draws draws;
  for (const double share : accepted) draws.accepted += share / kEnsembles;
  double slowest = 1;
  for (std::size_t i = 0; i < parameters; ++i) {
    draws.rhat.push_back(rhat_of(chain, i));
    slowest = std::max(slowest, correlation_steps(chain, i));
  }
  const std::size_t all = kept * walkers;
  draws.effective = static_cast<double>(all) / slowest;
  draws.count = std::min(options.draws, all);
  draws.unknowns.resize(draws.count * parameters);
  // Evenly over the steps, and over all walkers: those of one are not independent of each other.
  std::size_t stride = walkers * 5 / 8;
  while (std::gcd(stride, walkers) != 1) ++stride;
  for (std::size_t d = 0; d < draws.count; ++d) {
    const std::size_t step = (2 * d + 1) * kept / (2 * draws.count);
    const Vector& x = chain[step][d * stride % walkers];
    std::copy(x.begin(), x.end(),
              draws.unknowns.begin() + static_cast<std::ptrdiff_t>(d * parameters));
  }
  return draws;
}

}  // namespace bentaxis::designs

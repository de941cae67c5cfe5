#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "bentaxis/designs/identify.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/study/reporting.h"

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

// Where an unknown goes in the sampler, so that what the data know well is straight: products and
// ratios of what is positive, the stroke with the sine of the tilt, the arm of the teeth with the
// cosine of the pressure angle.
struct Coordinate {
  double (*inner)(double x);
  double (*outer)(double y);
  double (*stretch)(double x);  // logarithm of |dx/dy| at x, but for a constant
};
const Coordinate kOwn = {[](double x) { return x; }, [](double y) { return y; },
                         [](double) { return 0.0; }};
const Coordinate kLogarithm = {[](double x) { return std::log(x); },
                               [](double y) { return std::exp(y); },
                               [](double x) { return std::log(x); }};
const Coordinate kLogarithmOfSine = {
    [](double x) { return std::log(std::sin(x * kRadPerDegree)); },
    [](double y) { return std::asin(std::exp(y)) / kRadPerDegree; },
    [](double x) { return std::log(std::tan(x * kRadPerDegree)); }};
const Coordinate kLogarithmOfCosine = {
    [](double x) { return std::log(std::cos(x * kRadPerDegree)); },
    [](double y) { return std::acos(std::exp(y)) / kRadPerDegree; },
    [](double x) { return -std::log(std::tan(x * kRadPerDegree)); }};

const Coordinate& coordinate_of(const Unknown& u) {
  const bool acute = u.low > 0 && u.high < 90;
  const Scaling scaling = u.variable.parameter().scaling;
  if (acute && scaling == Scaling::sine) return kLogarithmOfSine;
  if (acute && scaling == Scaling::cosine) return kLogarithmOfCosine;
  return u.low > 0 ? kLogarithm : kOwn;
}

// The density in these coordinates.
class Density {
 public:
  explicit Density(const DataModel& model) : model_(model), problem_(model.problem()) {
    for (const Unknown& u : model.data().unknowns) coordinates_.push_back(coordinate_of(u));
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
  /// Logarithm of the posterior density of y, but for a constant.
  double operator()(const Vector& y) const {
    const Vector x = outer(y);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(x[i] >= problem_.low[i] && x[i] <= problem_.high[i])) return -HUGE_VAL;
      sum += coordinates_[i].stretch(x[i]);
      const auto& prior = model_.data().unknowns[i].prior;
      // Of a lognormal prior the residual is that of the logarithm.
      if (prior && prior->shape == Shape::lognormal) sum -= std::log(x[i]);
    }
    Vector residuals(problem_.residuals);
    if (!problem_.evaluate(x, residuals)) return -HUGE_VAL;
    for (const double r : residuals) sum -= r * r / 2;
    return sum;
  }
  const LeastSquaresProblem& problem() const { return problem_; }

 private:
  const DataModel& model_;
  LeastSquaresProblem problem_;
  std::vector<Coordinate> coordinates_;  // by unknown
};

// A place that data with errors of their own, and any start, could have led to: where the data
// leave a direction open such places lie all along it.
Vector scattered(const DataModel& model, const Density& density, const LeastSquaresFit& fit,
                 Random& random) {
  const LeastSquaresProblem& whole = density.problem();
  Vector noise(whole.residuals);
  std::size_t next = 0;
  for (const Datum& datum : model.data().data)
    if (datum.use == Use::fitted)
      for (std::size_t k = 0; k < datum.size(); ++k)
        noise[next++] = datum.value || datum.curve ? random.normal() : 0;
  while (next < noise.size()) noise[next++] = random.normal();
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
      if (sum_of_squares(residuals) < fit.sum_of_squares + 3 * static_cast<double>(model.size()))
        return found.x;
    } catch (const ComputationError&) {
      continue;
    }
  }
  return fit.x;
}

// An ensemble of walkers after Goodman & Weare (2010), half of whose moves are steps along the
// difference of two others (ter Braak 2006); moves of a half depend on the other half alone.
class Ensemble {
 public:
  Ensemble(const DataModel& model, const LeastSquaresFit& fit, std::uint64_t seed,
           std::size_t number)
      : density_(model), parameters_(model.size()) {
    const std::size_t count = std::max<std::size_t>(32, 3 * parameters_ + parameters_ % 2);
    for (std::size_t w = 0; w < count; ++w) random_.emplace_back(seed, number * count + w);
    places_.resize(count);
    heights_.resize(count);
    for (std::size_t w = 0; w < count; ++w) {
      places_[w] = density_.inner(scattered(model, density_, fit, random_[w]));
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

struct Moments {
  double mean = 0, variance = 0;
};
Moments moments_of(const Vector& values) {
  Moments m;
  for (const double v : values) m.mean += v;
  m.mean /= static_cast<double>(values.size());
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
  m.variance /= static_cast<double>(values.size() - 1);
  return m;
}

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
  double sum = 1;
  for (std::size_t lag = 1; lag < steps / 2; ++lag) {
    double product = 0;
    for (std::size_t s = 0; s + lag < steps; ++s)
      for (std::size_t w = 0; w < walkers; ++w)
        product += (chain[s][w][unknown] - whole.mean) * (chain[s + lag][w][unknown] - whole.mean);
    product /= static_cast<double>((steps - lag) * walkers) * whole.variance;
    sum += 2 * product;
    if (static_cast<double>(lag) > 5 * sum) break;
  }
  return std::max(sum, 1.0);
}

// Share q of sorted values.
double quantile_of(const Vector& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

}  // namespace

Posterior posterior_of(const DataModel& model, const LeastSquaresFit& fit,
                       const IdentifyOptions& options, const Progress& progress) {
  constexpr std::size_t kEnsembles = 2;  // that know nothing of each other: R-hat compares them too
  const auto steps = static_cast<std::size_t>(options.steps), kept = steps / 2;
  std::vector<Chain> parts(kEnsembles);
  std::vector<double> accepted(kEnsembles);
  study::Reporting reporting(kEnsembles * steps, progress);
  numerics::parallel_for(options.threads, kEnsembles, [&](std::size_t e) {
    Ensemble ensemble(model, fit, options.seed, e);
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
  Posterior posterior;
  for (const double share : accepted) posterior.accepted += share / kEnsembles;
  double slowest = 1;
  for (std::size_t i = 0; i < model.size(); ++i) {
    posterior.rhat.push_back(rhat_of(chain, i));
    slowest = std::max(slowest, correlation_steps(chain, i));
  }
  const std::size_t all = kept * walkers;
  posterior.effective = static_cast<double>(all) / slowest;
  posterior.count = std::min(static_cast<std::size_t>(options.draws), all);
  posterior.unknowns.resize(posterior.count * model.size());
  posterior.numbers.resize(posterior.count * model.numbers());
  // Evenly over the steps, and over all walkers: those of one are not independent of each other.
  std::size_t stride = walkers * 5 / 8;
  while (std::gcd(stride, walkers) != 1) ++stride;
  numerics::parallel_for(options.threads, posterior.count, [&](std::size_t d) {
    const std::size_t step = (2 * d + 1) * kept / (2 * posterior.count);
    const Vector& x = chain[step][d * stride % walkers];
    std::copy(x.begin(), x.end(),
              posterior.unknowns.begin() + static_cast<std::ptrdiff_t>(d * model.size()));
    model.predict(x, std::span(posterior.numbers).subspan(d * model.numbers(), model.numbers()));
  });
  return posterior;
}

void bands_of(const DataModel& model, const IdentifyOptions& options, Identification& result,
              const Progress& progress) {
  const Posterior& posterior = result.posterior;
  std::vector<ResultTable> turns(posterior.count);
  study::for_each_of(posterior.count, options.threads, progress, [&](std::size_t d) {
    turns[d] = model.turn(std::span(posterior.unknowns).subspan(d * model.size(), model.size()));
  });
  const ChannelLayout layout(model.base().pump);
  result.theta_deg = turns[0].theta_deg;
  const std::size_t rows = turns[0].rows();
  for (std::size_t column = 0; column < layout.reactions(); ++column) {
    const Channel& channel = layout.channels()[column];
    if (channel.piston > 1 || !is_computed(turns[0].at(0, column))) continue;
    ReactionBand band;
    band.column = column;
    for (std::size_t row = 0; row < rows; ++row) {
      Vector values;
      for (const ResultTable& turn : turns) values.push_back(turn.at(row, column));
      std::sort(values.begin(), values.end());
      band.low.push_back(quantile_of(values, 0.025));
      band.middle.push_back(quantile_of(values, 0.5));
      band.high.push_back(quantile_of(values, 0.975));
      band.half_width = std::max(band.half_width, (band.high.back() - band.low.back()) / 2);
      band.peak = std::max(band.peak, std::abs(band.middle.back()));
    }
    if (band.peak == 0) continue;  // no force there in this pump
    band.half_width /= band.peak;
    result.bands.push_back(std::move(band));
  }

  // What a further measurement would do, as if all were normal: a number m with noise u takes
  // cov(t, m)^2 / (var(m) + u^2) off the variance of a value t.
  std::vector<Moments> of_band(result.bands.size() * rows);
  for (std::size_t b = 0; b < result.bands.size(); ++b)
    for (std::size_t row = 0; row < rows; ++row) {
      Vector values;
      for (const ResultTable& turn : turns) values.push_back(turn.at(row, result.bands[b].column));
      of_band[b * rows + row] = moments_of(values);
    }
  std::vector<Output> outputs;
  for (const ReactionBand& band : result.bands)
    for (const char* statistic : {"mean:", "min:", "max:"})
      outputs.push_back(output(statistic + layout.channels()[band.column].name, model.base()));
  result.candidates.resize(outputs.size());
  numerics::parallel_for(options.threads, outputs.size(), [&](std::size_t c) {
    const Output& o = outputs[c];
    Vector measured;
    for (const ResultTable& turn : turns) {
      Vector curve;
      for (std::size_t row = 0; row < rows; ++row) curve.push_back(turn.at(row, o.columns[0]));
      measured.push_back(statistic_of(o.statistic, curve));
    }
    const Moments of_measured = moments_of(measured);
    Candidate candidate;
    candidate.output = o;
    candidate.deviation = options.measured * result.bands[c / 3].peak;  // three of each reaction
    const double variance = of_measured.variance + candidate.deviation * candidate.deviation;
    for (std::size_t b = 0; b < result.bands.size() && variance > 0; ++b) {
      double before = 0, off = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        const Moments& of_value = of_band[b * rows + row];
        double covariance = 0;
        for (std::size_t d = 0; d < turns.size(); ++d)
          covariance += (turns[d].at(row, result.bands[b].column) - of_value.mean) *
                        (measured[d] - of_measured.mean);
        covariance /= static_cast<double>(turns.size() - 1);
        before += of_value.variance;
        off += covariance * covariance / variance;
      }
      const double shrinks = before > 0 ? 1 - std::sqrt(std::max(1 - off / before, 0.0)) : 0;
      candidate.shrinks += shrinks / static_cast<double>(result.bands.size());
      if (shrinks > candidate.most_shrinks) {
        candidate.most_shrinks = shrinks;
        candidate.most = layout.channels()[result.bands[b].column].name;
      }
    }
    result.candidates[c] = std::move(candidate);
  });
  std::stable_sort(result.candidates.begin(), result.candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.shrinks > b.shrinks; });
}

}  // namespace bentaxis::designs

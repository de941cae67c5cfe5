#include <algorithm>
#include <cmath>

#include "bentaxis/designs/identify.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/study/reporting.h"
#include "moments.h"

namespace bentaxis::designs {
namespace {

using Vector = std::vector<double>;

// So that products and ratios of what is positive are straight, the stroke with the sine of the
// tilt, the arm of the teeth with the cosine of the pressure angle.
const SamplerCoordinate kLogarithmOfSine = {
    [](double x) { return std::log(std::sin(x * kRadPerDegree)); },
    [](double y) { return std::asin(std::exp(y)) / kRadPerDegree; },
    [](double x) { return std::log(std::tan(x * kRadPerDegree)); }};
const SamplerCoordinate kLogarithmOfCosine = {
    [](double x) { return std::log(std::cos(x * kRadPerDegree)); },
    [](double y) { return std::acos(std::exp(y)) / kRadPerDegree; },
    [](double x) { return -std::log(std::tan(x * kRadPerDegree)); }};

const SamplerCoordinate& coordinate_of(const Unknown& u) {
  const bool acute = u.low > 0 && u.high < 90;
  const Scaling scaling = u.variable.parameter().scaling;
  if (acute && scaling == Scaling::sine) return kLogarithmOfSine;
  if (acute && scaling == Scaling::cosine) return kLogarithmOfCosine;
  return u.low > 0 ? kLogarithmicCoordinate : kOwnCoordinate;
}

// Posterior of the unknowns between their bounds.
SampledDensity density_of(const DataModel& model) {
  const auto& unknowns = model.data().unknowns;
  SampledDensity density;
  density.problem = model.problem();
  for (const Unknown& u : unknowns) density.coordinates.push_back(coordinate_of(u));
  // Of a lognormal prior the residual is that of the logarithm.
  density.log_factor = [&unknowns](std::size_t i, double x) {
    const auto& prior = unknowns[i].prior;
    return prior && prior->shape == Shape::lognormal ? -std::log(x) : 0;
  };
  for (const Datum& datum : model.data().data)
    if (datum.use == Use::fitted)
      density.noisy.insert(density.noisy.end(), datum.size(), datum.value || datum.curve ? 1 : 0);
  density.noisy.resize(density.problem.residuals, 1);
  return density;
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
  Posterior posterior;
  static_cast<Draws&>(posterior) = draws_of(density_of(model), fit,
                                            {.seed = options.seed,
                                             .steps = static_cast<std::size_t>(options.steps),
                                             .draws = static_cast<std::size_t>(options.draws),
                                             .threads = options.threads},
                                            progress);
  posterior.numbers.resize(posterior.count * model.numbers());
  numerics::parallel_for(options.threads, posterior.count, [&](std::size_t d) {
    model.predict(std::span(posterior.unknowns).subspan(d * model.size(), model.size()),
                  std::span(posterior.numbers).subspan(d * model.numbers(), model.numbers()));
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
    candidate.measured = measured_as(layout.channels()[o.columns[0]].quantity);
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
                   [](const Candidate& a, const Candidate& b) {
                     return std::pair(a.measured, -a.shrinks) < std::pair(b.measured, -b.shrinks);
                   });
}

Measured measured_as(const std::string& quantity) {
  if (quantity == "Td") return Measured::on_a_rig;
  return quantity == "Rb1" || quantity == "Rb2" ? Measured::at_bearings : Measured::nowhere;
}

}  // namespace bentaxis::designs

#include "bentaxis/designs/uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bentaxis/designs/points.h"
#include "bentaxis/files/csv_rows.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/stopwatch.h"
#include "bentaxis/study/failed_point.h"

namespace bentaxis::designs {
namespace {

// Outputs of designs, and after them the curves: channel by channel, at every `stride`th angle.
class Designs {
 public:
  Designs(const Case& base, const UncertainVariables& variables, const UncertaintyOptions& options)
      : family_(base, variables.variables), options_(options) {
    if (options.curves) channels_ = banded_channels(base);
    const auto rows = static_cast<std::size_t>(base.operation.samples_per_revolution);
    const std::size_t bytes = rows * channels_.size() * options.samples * sizeof(double);
    stride_ = std::max<std::size_t>(1, (bytes + options.most_bytes - 1) / options.most_bytes);
    rows_ = channels_.empty() ? 0 : (rows + stride_ - 1) / stride_;
  }

  const std::vector<std::size_t>& channels() const { return channels_; }
  std::size_t stride() const { return stride_; }
  std::size_t rows() const { return rows_; }
  /// Outputs, then further numbers, then curves.
  std::size_t size() const { return before_curves() + rows_ * channels_.size(); }
  std::size_t before_curves() const { return options_.outputs.size() + options_.further.count; }

  std::vector<double> of(const Case& the_case) const {
    std::optional<study::PreparedCase> prepared;
    std::vector<double> all = outputs_of(options_.outputs, the_case, prepared, options_.model);
    for (std::size_t o = 0; o < all.size(); ++o)
      if (!is_computed(all[o]))
        throw InputError("output " + options_.outputs[o].name + ": is not computed");
    if (rows_ == 0 && options_.further.count == 0) return all;
    if (!prepared) prepared.emplace(study::prepare(the_case));
    const study::PreparedCase& ready = *prepared;
    const ResultTable table = study::run_turn(ready, options_.model);
    all.resize(before_curves());
    if (options_.further.count > 0)
      options_.further.of(ready, table, std::span(all).subspan(options_.outputs.size()));
    for (const std::size_t channel : channels_)
      for (std::size_t row = 0; row < rows_; ++row) all.push_back(table.at(row * stride_, channel));
    return all;
  }

  void operator()(std::size_t count, std::span<const double> values, std::span<double> results,
                  std::span<std::string> reasons) const {
    const std::size_t n = family_.variables().size();
    Case scratch = family_.base();
    for (std::size_t i = 0; i < count; ++i) {
      const auto to = results.subspan(i * size(), size());
      reasons[i] = study::reason_of([&] {
        family_.make(values.subspan(i * n, n), scratch);
        const std::vector<double> found = of(scratch);
        std::copy(found.begin(), found.end(), to.begin());
      });
      if (!reasons[i].empty()) std::fill(to.begin(), to.end(), not_computed());
    }
  }

 private:
  Family family_;
  const UncertaintyOptions& options_;
  std::vector<std::size_t> channels_;
  std::size_t stride_ = 1, rows_ = 0;
};

// Of all samples, column by column.
CurveBand band_of(const SampledOutputs& sampled, std::size_t first, std::size_t rows,
                  double level) {
  CurveBand band;
  const std::size_t samples = sampled.results.size() / sampled.outputs;
  const double tail = (1 - level) / 2;
  const QuantileRule low(tail, samples), median(0.5, samples), high(1 - tail, samples);
  std::vector<bool> inside(samples, true);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::vector<double> values = sampled.of(first + row);
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const Estimate below = low(sorted), above = high(sorted);
    double mean = 0, squares = 0;
    for (const double v : values) mean += (v - values.front()) / static_cast<double>(samples);
    mean += values.front();
    for (const double v : values) squares += (v - mean) * (v - mean);
    band.low.push_back(below.value);
    band.median.push_back(median(sorted).value);
    band.high.push_back(above.value);
    band.deviation.push_back(std::sqrt(squares / static_cast<double>(samples - 1)));
    band.widest = std::max(band.widest, (above.value - below.value) / 2);
    for (const Estimate& edge : {below, above})
      band.edge_error = std::max(band.edge_error, (edge.high - edge.low) / 2);
    for (std::size_t i = 0; i < samples; ++i)
      inside[i] = inside[i] && values[i] >= below.value && values[i] <= above.value;
  }
  band.throughout = static_cast<double>(std::count(inside.begin(), inside.end(), true)) /
                    static_cast<double>(samples);
  return band;
}

// Visits the samples that have outputs, by number, with their parameters.
template <class Visit>
void for_each_kept(const UncertainVariables& variables, const UncertaintyOptions& options,
                   const SampledOutputs& sampled, const Visit& visit) {
  const auto points = random(variables.size(), options.samples, options.seed);
  std::vector<double> shares(variables.size()), values(variables.size());
  auto without = sampled.infeasible.begin();
  for (std::size_t i = 0; i < options.samples; ++i) {
    if (without != sampled.infeasible.end() && without->first == i) {
      ++without;
      continue;
    }
    points->point(i, shares);
    variables.values(shares, values);
    visit(i, values);
  }
}

// Their parameters.
std::vector<Spread> kept_parameters(const UncertainVariables& variables,
                                    const UncertaintyOptions& options,
                                    const SampledOutputs& sampled) {
  std::vector<std::vector<double>> columns(variables.size());
  for_each_kept(variables, options, sampled, [&](std::size_t, const std::vector<double>& values) {
    for (std::size_t v = 0; v < values.size(); ++v) columns[v].push_back(values[v]);
  });
  std::vector<Spread> kept;
  for (std::vector<double>& column : columns)
    kept.push_back(spread_of(std::move(column), options.level));
  return kept;
}

// The outputs alone.
SampledOutputs without_curves(const SampledOutputs& sampled, std::size_t outputs) {
  SampledOutputs few;
  few.outputs = outputs;
  few.infeasible = sampled.infeasible;
  for (std::size_t i = 0; i < sampled.results.size(); i += sampled.outputs)
    few.results.insert(few.results.end(), sampled.results.begin() + i,
                       sampled.results.begin() + i + outputs);
  return few;
}

// Refuses what leaves too little to speak of, or fewer samples than the quantiles need that were
// asked for.
void check(const SampledOutputs& sampled, const UncertaintyOptions& options) {
  const std::size_t without = sampled.infeasible.size(), fewest = fewest_samples(options.level);
  if (2 * without > options.samples ||
      options.samples - without < (options.samples < fewest ? kFewestSamples : fewest))
    throw ComputationError(
        std::to_string(without) + " of " + std::to_string(options.samples) +
        " samples are infeasible pumps; the first: " + sampled.infeasible.front().second);
}

}  // namespace

std::vector<std::size_t> banded_channels(const Case& the_case) {
  const ChannelLayout layout(the_case.pump);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < layout.channels().size(); ++i)
    if (const Channel& c = layout.channels()[i]; c.kind == ChannelKind::reaction && c.piston <= 1)
      found.push_back(i);
  return found;
}

void check_sampling(const Case& the_case, std::size_t samples, double level) {
  if (samples < fewest_samples(level))
    throw InputError(std::to_string(samples) + " samples: must be at least " +
                     std::to_string(fewest_samples(level)) + " for the quantiles of a level of " +
                     number_text(level));
  uncertain_variables(the_case);
}

std::string UncertaintyResult::too_few_text() const {
  constexpr std::size_t kDeviationKnown = 51;  // to 10 %
  const std::size_t fewest = fewest_samples(options.level);
  if (kept() >= std::max(fewest, kDeviationKnown)) return "";
  std::string text =
      fmt::format("{} are too few for reliable statistics: ", counted(kept(), "sample"));
  if (kept() < kDeviationKnown)
    text += fmt::format("a standard deviation is known to about {:.0f} % (to 10 % from {} on)",
                        100 * deviation_known_to(kept()), kDeviationKnown);
  if (kept() < fewest)
    text += fmt::format(
        "{}the quantiles and bands that hold {:g} % of the pumps need {} (--samples) "
        "and are not given",
        kept() < kDeviationKnown ? "; " : "", 100 * options.level, fewest);
  return text;
}

UncertaintyResult uncertainty(const Case& the_case, const UncertaintyOptions& asked,
                              const study::PartProgress& progress_of) {
  const Stopwatch stopwatch;
  if (asked.samples < kFewestSamples)
    throw InputError("--samples " + std::to_string(asked.samples) + ": must be at least " +
                     std::to_string(kFewestSamples));
  UncertaintyOptions options = asked;
  if (options.samples < fewest_samples(options.level)) options.curves = false;
  UncertaintyResult result;
  result.the_case = the_case;
  result.options = options;
  result.variables = uncertain_variables(the_case);
  const UncertainVariables& variables = result.variables;
  if (options.sobol > 0 && options.sobol < kFewestBasePoints)
    throw InputError("--sobol: " + std::to_string(options.sobol) + ": must be at least " +
                     std::to_string(kFewestBasePoints) + ", or 0: none");
  if (options.sobol > 0 && !variables.independent())
    throw InputError("--sobol: needs independent parameters: [uncertainty] correlates some");
  if (options.sobol > 0) require_sobol_indices();
  const Designs designs(the_case, variables, options);
  const std::size_t outputs = options.outputs.size();
  const std::vector<double> nominal = designs.of(the_case);

  const SampledOutputs sampled =
      sample(std::cref(designs), designs.size(), variables, options.samples, options.seed,
             options.threads, progress_of("Monte Carlo"));
  check(sampled, options);
  for (std::size_t o = 0; o < outputs; ++o)
    result.outputs.push_back(
        {options.outputs[o], nominal[o], spread_of(sampled.of(o), options.level)});
  for (std::size_t i = outputs; i < designs.before_curves(); ++i)
    result.further.push_back(spread_of(sampled.of(i), options.level));
  result.angles = static_cast<std::size_t>(the_case.operation.samples_per_revolution);
  for (std::size_t row = 0; row < designs.rows(); ++row)
    result.theta_deg.push_back(360.0 * static_cast<double>(row * designs.stride()) /
                               static_cast<double>(result.angles));
  const ChannelLayout layout(the_case.pump);
  for (std::size_t c = 0; c < designs.channels().size(); ++c) {
    const std::size_t first = designs.before_curves() + c * designs.rows();
    if (!is_computed(nominal[first])) continue;  // the block's speed is imposed: no tooth force
    CurveBand band = band_of(sampled, first, designs.rows(), options.level);
    band.channel = layout.channels()[designs.channels()[c]];
    band.nominal.assign(nominal.begin() + first, nominal.begin() + first + designs.rows());
    result.bands.push_back(std::move(band));
  }
  for (CurveBand& band : result.bands)  // of the vector, which its components share
    for (std::size_t row = 0; row < designs.rows(); ++row) {
      double square = 0;
      for (const CurveBand& other : result.bands)
        if (other.channel.group == band.channel.group)
          square += other.nominal[row] * other.nominal[row];
      band.peak = std::max(band.peak, std::sqrt(square));
    }
  result.sampled = without_curves(sampled, outputs);
  if (!sampled.infeasible.empty())
    result.kept_parameters = kept_parameters(variables, options, sampled);

  UncertaintyOptions of_outputs = options;
  of_outputs.curves = false;
  of_outputs.further = {};
  if (options.first_order)
    result.first_order = first_order(Designs(the_case, variables, of_outputs), outputs, variables);
  if (options.sobol > 0) {
    const Evaluator evaluator(Family(the_case, variables.variables), options.outputs,
                              options.model);
    result.sobol = sobol_indices(
        [&](std::size_t count, std::span<const double> values, std::span<double> results,
            std::span<std::string> reasons) {
          evaluator.evaluate(count, values, results, reasons);
        },
        outputs, variables, options.sobol, options.seed, options.threads,
        progress_of("Sobol indices"));
  }
  result.seconds = stopwatch.seconds();
  return result;
}

std::string outputs_csv(const UncertaintyResult& result) {
  CsvRows csv(
      "output,unit,nominal,mean,mean_error,deviation,deviation_error,low,low_from,low_to,median,"
      "median_from,median_to,high,high_from,high_to,first_order_value,first_order_deviation");
  const FirstOrder& first = result.first_order;
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    const auto& [output, nominal, s] = result.outputs[o];
    std::vector<double> numbers = {nominal, s.mean, s.mean_error, s.deviation, s.deviation_error};
    for (const Estimate& e : {s.low, s.median, s.high})
      numbers.insert(numbers.end(), {e.value, e.low, e.high});
    const bool is_there = !first.values.empty();
    numbers.push_back(is_there ? first.values[o] : not_computed());
    numbers.push_back(is_there ? first.deviations[o] : not_computed());
    csv.row(output.name, output.unit, numbers);
  }
  return std::move(csv).text();
}

std::string bands_csv(const UncertaintyResult& result) {
  if (result.bands.empty()) return "";
  std::string header = "theta_deg";
  for (const CurveBand& band : result.bands)
    for (const char* what : {"_nominal", "_low", "_median", "_high"})
      header += "," + band.channel.name + what;
  CsvRows csv(header);
  for (std::size_t row = 0; row < result.theta_deg.size(); ++row) {
    std::vector<double> numbers = {result.theta_deg[row]};
    for (const CurveBand& band : result.bands)
      for (const auto* curve : {&band.nominal, &band.low, &band.median, &band.high})
        numbers.push_back((*curve)[row]);
    csv.row(numbers);
  }
  return std::move(csv).text();
}

std::string samples_csv(const UncertaintyResult& result) {
  const UncertainVariables& variables = result.variables;
  std::string header = "sample";
  for (const Variable& v : variables.variables) header += "," + v.name();
  for (const UncertainOutput& o : result.outputs) header += "," + o.output.name;
  CsvRows csv(header);
  const auto outputs = static_cast<std::ptrdiff_t>(result.outputs.size());
  auto value = result.sampled.results.begin();
  for_each_kept(variables, result.options, result.sampled,
                [&](std::size_t sample, const std::vector<double>& values) {
                  csv.row(sample, values, std::vector<double>(value, value + outputs));
                  value += outputs;
                });
  return std::move(csv).text();
}

}  // namespace bentaxis::designs

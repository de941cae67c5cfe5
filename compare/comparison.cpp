#include "bentaxis/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/column_values.h"

namespace bentaxis::compare {
namespace {

// An amplitude below this share of the peak is round-off: it has no phase.
constexpr double kZeroAmplitude = 1e-12;

// Samples per turn if the table covers whole turns evenly, else 0.
std::size_t samples_per_turn(const std::vector<double>& theta) {
  if (theta.size() < 2) return 0;
  const double step = theta[1] - theta[0];
  const double turns = step * static_cast<double>(theta.size()) / 360;
  const double whole = std::round(turns);
  if (whole == 0 || std::abs(turns - whole) > 1e-9) return 0;
  for (std::size_t i = 1; i < theta.size(); ++i)
    if (std::abs(theta[i] - theta[0] - step * static_cast<double>(i)) > 1e-9) return 0;
  return static_cast<std::size_t>(
      std::llround(static_cast<double>(theta.size()) / std::abs(whole)));
}

std::complex<double> fourier(const ResultTable& table, std::size_t column, int order) {
  std::complex<double> sum = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    sum += table.at(row, column) * std::polar(1.0, order * radians(table.theta_deg[row]));
  return sum * 2.0 / static_cast<double>(table.rows());
}

double load_of(const Channel& channel, const ZeroScales& loads) {
  const auto load = loads.find(channel.unit);
  return load == loads.end() ? 0 : load->second;
}

// A value that a table lacks.
struct Gap {
  bool expected = true;
  Comparable why = Comparable::nothing;
  std::string text = {};
};

// The first gap of a channel that is not expected, else one that leaves nothing to compare: where
// one table has values that the other lacks. A column that is not there is missing at every row.
std::optional<Gap> find_gap(const ResultTable& first, std::size_t a, const ResultTable& second,
                            std::size_t b, const Channel& channel, const Options& options) {
  std::optional<Gap> gap;
  for (std::size_t row = 0; row < first.rows(); ++row) {
    const double x = a < first.columns() ? first.at(row, a) : not_computed();
    const double y = b < second.columns() ? second.at(row, b) : not_computed();
    const Comparable why = comparable(x, y);
    if (why == Comparable::yes && options.band &&
        !(std::isfinite(options.band->low->at(row, a)) &&
          std::isfinite(options.band->high->at(row, a))))
      return Gap{false, Comparable::not_finite,
                 "no finite limit of the band at " + number_text(first.theta_deg[row]) + " deg"};
    if (why == Comparable::yes) continue;
    const bool both = why == Comparable::both_missing;
    if (why != Comparable::not_finite &&
        (options.may_be_missing ? options.may_be_missing(channel, row) : both)) {
      if (!both) gap = Gap{true, why};
      continue;
    }
    const std::string table = std::isfinite(x)   ? second.name
                              : std::isfinite(y) ? first.name
                                                 : first.name + " and " + second.name;
    return Gap{false, why,
               std::string(why == Comparable::not_finite ? "no finite value" : "no value") +
                   " of " + table + " at " + number_text(first.theta_deg[row]) + " deg"};
  }
  return gap;
}

// Statistics of a channel at the rows that both tables have.
void compare_channel(const ResultTable& first, std::size_t a, const ResultTable& second,
                     std::size_t b, const Options& options, ChannelComparison& result) {
  std::size_t both = 0;
  double square = 0;
  double share = 0, uncertainty_there = 0;  // at the row nearest to its limit, or furthest beyond
  const std::size_t off =
      options.uncertainty ? options.uncertainty->find(first.channels[a].name) : 0;
  const bool uncertain = options.uncertainty && off < options.uncertainty->columns();
  for (std::size_t row = 0; row < first.rows(); ++row) {
    const double x = first.at(row, a);
    const double y = second.at(row, b);
    if (!is_computed(x)) continue;
    ++both;
    result.own_peak = std::max(result.own_peak, std::abs(x));
    double difference = y - x;
    if (options.band) {
      const double low = options.band->low->at(row, a);
      const double high = options.band->high->at(row, a);
      difference = y < low ? y - low : y > high ? y - high : 0;
    }
    square += difference * difference;
    result.mean[0] += x;
    result.mean[1] += y;
    result.mean_difference += difference;
    const double uncertainty = uncertain ? options.uncertainty->at(row, off) : 0;
    const Difference here{std::abs(difference), result.allowed + uncertainty, Comparable::yes};
    if (both == 1 || !(here.share() <= share)) {
      share = here.share();
      uncertainty_there = uncertainty;
      result.largest = std::abs(difference);
      result.theta_of_largest_deg = first.theta_deg[row];
    }
  }
  if (both == 0) return;
  result.allowed += uncertainty_there;
  const auto count = static_cast<double>(both);
  result.rms = std::sqrt(square / count);
  for (double* value : {&result.mean[0], &result.mean[1], &result.mean_difference}) *value /= count;
  result.verdict = result.largest <= result.allowed ? Verdict::agrees : Verdict::differs;
  const double relative = result.largest_over_peak();
  result.digits = relative > 0 ? std::clamp(-std::log10(relative), 0.0, options.most_digits)
                               : options.most_digits;
}

// Amplitude and phase of the orders that the samples resolve.
void add_harmonics(const ResultTable& first, std::size_t a, const ResultTable& second,
                   std::size_t b, std::size_t per_turn, const std::vector<int>& orders,
                   ChannelComparison& result) {
  for (const int order : orders) {
    if (per_turn <= static_cast<std::size_t>(2 * order)) continue;  // would alias
    Harmonic harmonic;
    harmonic.order = order;
    const std::complex<double> values[2] = {fourier(first, a, order), fourier(second, b, order)};
    if (!std::isfinite(std::abs(values[0]))) continue;  // not computed everywhere
    for (int i = 0; i < 2; ++i) {
      harmonic.amplitude[i] = std::abs(values[i]);
      if (harmonic.amplitude[i] > kZeroAmplitude * result.peak)
        harmonic.phase_deg[i] = std::arg(values[i]) / kRadPerDegree;
    }
    result.harmonics.push_back(harmonic);
  }
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees:
      return "agrees";
    case Verdict::differs:
      return "differs";
    case Verdict::explained:
      return "explained";
    case Verdict::incomplete:
      return "incomplete";
    case Verdict::not_computed:
      break;
  }
  return "not computed";
}

std::string scale_in_words(const ChannelComparison& channel) {
  return channel.at_floor ? "the scale of the loads, as its own peak is far smaller" : "its peak";
}

Options above_round_off(double tolerance, const ZeroScales& scales) {
  Options options;
  options.tolerance = tolerance;
  options.zero_scales = scales;
  return options;
}

bool ChannelComparison::is_small_component() const {
  return judged && compared() && own_peak < kSmallComponent * peak && own_peak > kNoSignal * peak;
}

bool Comparison::agrees() const {
  return compared() > 0 && incomplete() == nullptr &&
         std::none_of(channels.begin(), channels.end(),
                      [](const auto& c) { return c.judged && c.verdict == Verdict::differs; });
}

const ChannelComparison* Comparison::incomplete() const {
  for (const auto& c : channels)
    if (c.judged && c.verdict == Verdict::incomplete) return &c;
  return nullptr;
}

const ChannelComparison* Comparison::failed() const {
  const ChannelComparison* failed = nullptr;
  const auto beyond = [](const ChannelComparison& c) {
    return Difference{c.largest, c.allowed, Comparable::yes}.share();
  };
  for (const auto& c : channels)
    if (c.judged && c.verdict == Verdict::differs &&
        (failed == nullptr || !(beyond(c) <= beyond(*failed))))
      failed = &c;
  return failed;
}

const ChannelComparison* Comparison::worst() const {
  if (const ChannelComparison* const beyond = failed()) return beyond;
  const ChannelComparison* worst = nullptr;
  for (const auto& c : channels) {
    if (!c.judged || !c.compared()) continue;
    if (worst == nullptr || c.largest_over_peak() > worst->largest_over_peak()) worst = &c;
  }
  return worst;
}

const ChannelComparison* Comparison::furthest(const std::function<bool(const Channel&)>& of) const {
  const ChannelComparison* furthest = nullptr;
  Difference largest;
  for (const auto& c : channels)
    if (c.verdict != Verdict::not_computed && of(c.channel) && largest.keep_larger(c.difference()))
      furthest = &c;
  return furthest;
}

int Comparison::compared() const {
  return static_cast<int>(std::count_if(channels.begin(), channels.end(),
                                        [](const auto& c) { return c.judged && c.compared(); }));
}

const ChannelComparison* Comparison::find(const std::string& channel_name) const {
  for (const auto& c : channels)
    if (c.channel.name == channel_name) return &c;
  return nullptr;
}

double scale_of(double peak, double load) {
  return peak <= kNoSignal * load ? load : std::max(peak, kMinScale * load);
}

double scale_of(const ResultTable& table, const Channel& channel, const ZeroScales& zero_scales) {
  return scale_of(table.peak(channel.group), load_of(channel, zero_scales));
}

Comparison compare_tables(const ResultTable& first, const ResultTable& second,
                          const Options& options) {
  if (first.theta_deg != second.theta_deg)
    throw InputError("tables \"" + first.name + "\" and \"" + second.name +
                     "\" have different shaft angles");
  Comparison comparison;
  comparison.first = first.name;
  comparison.second = second.name;
  comparison.tolerance = options.tolerance;
  const std::size_t per_turn = samples_per_turn(first.theta_deg);
  std::map<std::string, double> peaks;  // by group
  const auto add = [&](const Channel& channel, std::size_t a, std::size_t b) {
    if (channel.kind == ChannelKind::check) return;
    ChannelComparison result;
    result.channel = channel;
    result.tolerance = options.tolerance;
    result.judged = channel.kind == ChannelKind::reaction || channel.kind == ChannelKind::derived;
    auto peak = peaks.find(channel.group);
    if (peak == peaks.end()) peak = peaks.emplace(channel.group, first.peak(channel.group)).first;
    result.peak = scale_of(peak->second, load_of(channel, options.zero_scales));
    result.at_floor = peak->second < result.peak;
    const auto absolute = options.absolute.find(channel.unit);
    result.allowed = options.tolerance * result.peak +
                     (absolute == options.absolute.end() ? 0 : absolute->second);
    if (const auto gap = find_gap(first, a, second, b, channel, options)) {
      result.verdict = gap->expected ? Verdict::not_computed : Verdict::incomplete;
      result.missing = gap->why;
      result.gap = gap->text;
    } else if (a < first.columns() && b < second.columns()) {
      compare_channel(first, a, second, b, options, result);
    }
    if (result.compared()) add_harmonics(first, a, second, b, per_turn, options.orders, result);
    comparison.channels.push_back(std::move(result));
  };
  for (std::size_t a = 0; a < first.columns(); ++a)
    add(first.channels[a], a, second.find(first.channels[a].name));
  for (std::size_t b = 0; b < second.columns(); ++b)
    if (first.find(second.channels[b].name) == first.columns())
      add(second.channels[b], first.columns(), b);
  return comparison;
}

const Check* failed_check(const std::vector<Check>& checks) {
  const Check* failed = nullptr;
  const auto beyond = [](const Check& check) { return check.relative() / check.tolerance; };
  for (const Check& check : checks)
    if (!check.holds() && (failed == nullptr || !(beyond(check) <= beyond(*failed))))
      failed = &check;
  return failed;
}

std::vector<Check> judge_checks(const ResultTable& table, const ZeroScales& scales,
                                double tolerance) {
  std::vector<Check> checks;
  for (std::size_t column = 0; column < table.columns(); ++column) {
    const Channel& channel = table.channels[column];
    // A check that nobody computed has not been passed.
    if (channel.kind != ChannelKind::check || !any_computed(table, column)) continue;
    auto it = std::find_if(checks.begin(), checks.end(),
                           [&](const Check& check) { return check.name == channel.meaning; });
    if (it == checks.end()) {
      Check check;
      check.table = table.name;
      check.name = channel.meaning;
      check.unit = channel.unit;
      if (channel.quantity == "power_residual") check.group = "Td";
      const auto own = scales.find(channel.quantity);
      const auto scale = own != scales.end() ? own : scales.find(channel.unit);
      check.scale = scale == scales.end() ? 1 : scale->second;
      check.tolerance = tolerance;
      checks.push_back(check);
      it = checks.end() - 1;
    }
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double value = table.at(row, column);
      if (is_computed(value) && std::abs(value) > it->worst) {
        it->worst = std::abs(value);
        it->theta_deg = table.theta_deg[row];
      }
    }
  }
  return checks;
}

}  // namespace bentaxis::compare

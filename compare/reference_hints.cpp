#include "reference_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/number.h"
#include "reference_angles.h"

namespace bentaxis::compare {
namespace {

// A hint is given where it explains all but this share of the difference...
constexpr double kExplained = 0.01;
// ...or of a shifted curve this share: the spline between its points is not exact.
constexpr double kExplainedByShift = 0.25;
// ...or of an offset this one: it is the whole cause.
constexpr double kLeftByOffset = 0.1;
// Of shifts that leave as much but for this share the smallest is meant.
constexpr double kAsGood = 0.01;
// Hints look at no more angles than this.
constexpr std::size_t kHintRows = 90;

double rms(const std::vector<double>& theirs, const std::vector<double>& ours, double factor = 1) {
  double sum = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double difference = ours[i] - factor * theirs[i];
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(ours.size()));
}

// Theirs times the factor that fits ours best.
double best_factor(const std::vector<double>& theirs, const std::vector<double>& ours) {
  double product = 0, square = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    product += theirs[i] * ours[i];
    square += theirs[i] * theirs[i];
  }
  return square > 0 ? product / square : 0;
}

double mean_difference(const std::vector<double>& theirs, const std::vector<double>& ours) {
  double mean = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    mean += (ours[i] - theirs[i]) / static_cast<double>(ours.size());
  return mean;
}

}  // namespace

Hints::Hints(const ResultTable& reference, const ResultTable& result)
    : reference_(reference), result_(result) {
  const std::size_t stride = 1 + (result.rows() - 1) / kHintRows;
  for (std::size_t row = 0; row < result.rows(); row += stride) rows_.push_back(row);
}

std::vector<double> Hints::values_of(const ResultTable& table, std::size_t column) const {
  std::vector<double> values;
  for (const auto row : rows_) values.push_back(table.at(row, column));
  return values;
}

std::string Hints::of(const ChannelComparison& channel) const {
  const std::size_t column = reference_.find(channel.channel.name);
  const std::vector<double> theirs = values_of(reference_, column);
  const std::vector<double> ours = values_of(result_, result_.find(channel.channel.name));
  for (const auto* values : {&theirs, &ours})
    if (!std::all_of(values->begin(), values->end(), is_computed)) return "";
  const double original = rms(theirs, ours);
  const double enough = std::max(kExplained * original, channel.allowed);
  for (std::size_t other = 0; other < reference_.columns(); ++other)
    if (other != column && reference_.channels[other].unit == channel.channel.unit &&
        rms(values_of(reference_, other), ours) <= enough)
      return "the reference has this curve as " + reference_.channels[other].name;
  const double factor = best_factor(theirs, ours), offset = mean_difference(theirs, ours);
  std::vector<double> moved = theirs;
  for (double& value : moved) value += offset;
  const double with_factor = rms(theirs, ours, factor), with_offset = rms(moved, ours);
  if (with_offset <= std::min(enough, kLeftByOffset * original) && with_offset < with_factor)
    return fmt::format("the result is the reference {} {:.4g} {} at every angle",
                       offset < 0 ? "less" : "plus", std::abs(offset), channel.channel.unit);
  if (std::abs(factor - 1) > kExplained && with_factor <= enough)
    return std::abs(factor + 1) < kExplained
               ? std::string("the reference has the opposite sign")
               : fmt::format("the result is {:.7g} times the reference", factor);
  const double shift = best_shift(column, ours);
  if (shift != 0 && shifted_rms(column, ours, shift) <= kExplainedByShift * original)
    return fmt::format("the result is the reference shifted by about {:+.2f} deg", shift);
  return "";
}

double Hints::shifted_rms(std::size_t column, const std::vector<double>& ours,
                          double shift) const {
  std::vector<double> moved;
  for (const auto row : rows_) moved.push_back(spline(column)(result_.theta_deg[row] - shift));
  return rms(moved, ours);
}

double Hints::best_shift(std::size_t column, const std::vector<double>& ours) const {
  if (reference_.rows() < 3) return 0;
  struct Shift {
    double deg, rms;
  };
  const auto at = [&](double deg) { return Shift{deg, shifted_rms(column, ours, deg)}; };
  const auto search = [&](Shift best, double reach, double step) {
    const double around = best.deg;
    for (double deg = around - reach; deg <= around + reach; deg += step)
      if (const Shift there = at(deg); there.rms < best.rms) best = there;
    return best;
  };
  // A curve that repeats fits at several shifts: of those that are as good the smallest.
  std::vector<Shift> degrees;
  for (int deg = -181; deg <= 181; ++deg) degrees.push_back(at(deg));
  std::vector<Shift> fits;
  for (std::size_t i = 1; i + 1 < degrees.size(); ++i)
    if (degrees[i].rms <= degrees[i - 1].rms && degrees[i].rms <= degrees[i + 1].rms)
      fits.push_back(search(search(degrees[i], 1, 0.1), 0.1, 0.01));
  const Shift none = at(0);
  Shift best = none;
  for (const Shift& fit : fits)
    if (fit.rms < best.rms) best = fit;
  const double as_good = best.rms + kAsGood * none.rms;
  for (const Shift& fit : fits)
    if (fit.rms <= as_good && std::abs(fit.deg) < std::abs(best.deg)) best.deg = fit.deg;
  return best.deg;
}

const PeriodicSpline& Hints::spline(std::size_t column) const {
  auto it = splines_.find(column);
  if (it == splines_.end()) {
    // Falling angles of a turn run backwards are put in order.
    std::map<double, double> points;
    for (std::size_t row = 0; row < reference_.rows(); ++row)
      points[reduced(reference_.theta_deg[row])] = reference_.at(row, column);
    std::vector<double> x, y;
    for (const auto& [angle, value] : points) {
      x.push_back(angle);
      y.push_back(value);
    }
    it = splines_.emplace(column, PeriodicSpline(x, y)).first;
  }
  return it->second;
}

}  // namespace bentaxis::compare

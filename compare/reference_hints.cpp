#include "reference_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "reference_angles.h"
#include "reference_resampling.h"

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

// A column over the turn, in the order of the angles: those of a turn run backwards fall.
struct Curve {
  std::vector<double> theta_deg, values;
};
Curve curve_of(const ResultTable& table, std::size_t column) {
  std::map<double, double> points;
  for (std::size_t row = 0; row < table.rows(); ++row)
    points[reduced(table.theta_deg[row])] = table.at(row, column);
  Curve curve;
  for (const auto& [angle, value] : points) {
    curve.theta_deg.push_back(angle);
    curve.values.push_back(value);
  }
  return curve;
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
  const Shift shift = best_shift(column, ours, period_of(channel.channel));
  if (shift.deg != 0 && shift.rms <= kExplainedByShift * original)
    return fmt::format("the result is the reference shifted by about {:+.2f} deg", shift.deg);
  return "";
}

double Hints::period_of(const Channel& channel) const {
  int pistons = 1;
  for (const Channel& other : result_.channels) pistons = std::max(pistons, other.piston);
  if (channel.piston > 0 || pistons == 1 || result_.rows() < 3) return 360;
  constexpr double kRoundOff = 1e-9;  // of peak
  const Curve curve = curve_of(result_, result_.find(channel.name));
  const PeriodicSpline spline(curve.theta_deg, curve.values);
  const std::vector<double> errors = resampling_errors(curve.theta_deg, curve.values);
  const double round_off = kRoundOff * result_.peak(channel.group);
  const auto repeats_after = [&](double period) {
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
      const double before = reduced(curve.theta_deg[i] - period);
      const bool is_point = find_angle(curve.theta_deg, before, kSameAngle) < curve.values.size();
      const double off = is_point ? 0 : errors[interval_of(curve.theta_deg, before)];
      if (std::abs(spline(before) - curve.values[i]) > off + round_off) return false;
    }
    return true;
  };
  // An odd number of pistons under an ideal pressure repeats some curves after half a pitch.
  for (const double period : {180.0 / pistons, 360.0 / pistons})
    if (repeats_after(period)) return period;
  return 360;
}

Hints::Shift Hints::best_shift(std::size_t column, const std::vector<double>& ours,
                               double period) const {
  if (reference_.rows() < 3) return {};
  const Curve curve = curve_of(reference_, column);
  const PeriodicSpline spline(curve.theta_deg, curve.values);
  // Shifts by a period more are the same, although the spline leaves another rest of each.
  const auto at = [&](double deg) {
    Shift found{deg, std::numeric_limits<double>::max()};
    for (double same = deg; same < deg + 360 - period / 2; same += period) {
      std::vector<double> moved;
      for (const auto row : rows_) moved.push_back(spline(result_.theta_deg[row] - same));
      found.rms = std::min(found.rms, rms(moved, ours));
    }
    return found;
  };
  const auto search = [&](Shift best, double reach, double step) {
    const double around = best.deg;
    for (double deg = around - reach; deg <= around + reach; deg += step)
      if (const Shift there = at(deg); there.rms < best.rms) best = there;
    return best;
  };
  // A curve may fit at several shifts: of those that are as good the smallest.
  std::vector<Shift> degrees;
  const int half = static_cast<int>(std::ceil(period / 2)) + 1;
  for (int deg = -half; deg <= half; ++deg) degrees.push_back(at(deg));
  std::vector<Shift> fits;
  for (std::size_t i = 1; i + 1 < degrees.size(); ++i)
    if (degrees[i].rms <= degrees[i - 1].rms && degrees[i].rms <= degrees[i + 1].rms) {
      fits.push_back(search(search(degrees[i], 1, 0.1), 0.1, 0.01));
      fits.back().deg = std::remainder(fits.back().deg, period);
    }
  const Shift none = at(0);
  Shift best = none;
  for (const Shift& fit : fits)
    if (fit.rms < best.rms) best = fit;
  const double as_good = best.rms + kAsGood * none.rms;
  for (const Shift& fit : fits)
    if (fit.rms <= as_good && std::abs(fit.deg) < std::abs(best.deg)) best = fit;
  return best;
}

}  // namespace bentaxis::compare

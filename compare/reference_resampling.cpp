#include "reference_resampling.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/column_values.h"
#include "reference_angles.h"

namespace bentaxis::compare {
namespace {

// A value on the straight line between two points.
struct Between {
  std::size_t first, next;
  double share;
};

// Where a curve is looked at to find what it spans over [at - half, at + half]: its points there
// and the straight lines to the ends.
std::vector<Between> points_near(const std::vector<double>& theta, double at, double half) {
  std::vector<Between> points;
  const std::size_t n = theta.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    const double step = wrap_degrees(theta[next] - theta[i]);
    for (const double end : {at - half, at + half}) {
      const double past = wrap_degrees(end - theta[i]);
      if (past <= step) points.push_back({i, next, past / step});
    }
    const double past = wrap_degrees(theta[i] - at);
    if (std::min(past, 360 - past) <= half) points.push_back({i, i, 0});
  }
  return points;
}

// How far the spline through every other point misses those between, per point.
std::vector<double> misses(const std::vector<double>& theta, const std::vector<double>& values) {
  std::vector<double> miss(theta.size(), 0);
  for (std::size_t start = 0; start < 2; ++start) {
    std::vector<double> x, y;
    for (std::size_t i = start; i < theta.size(); i += 2) {
      x.push_back(theta[i]);
      y.push_back(values[i]);
    }
    if (x.size() < 3) continue;
    const PeriodicSpline spline(x, y);
    for (std::size_t i = 1 - start; i < theta.size(); i += 2)
      miss[i] = std::abs(spline(theta[i]) - values[i]);
  }
  return miss;
}

// The largest of some rows on either side of each interval, which begins at point i.
std::vector<double> largest_nearby(const std::vector<double>& values) {
  constexpr std::size_t kReach = 4;
  const std::size_t n = values.size();
  std::vector<double> out(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k <= 2 * kReach + 1 && k < n; ++k)
      out[i] = std::max(out[i], values[(i + n * kReach - kReach + k) % n]);
  return out;
}

// Values of the band that a curve spans around angles: what it has at its points there and on the
// straight lines between.
struct Span {
  double low, high;
};
Span span_of(const std::vector<double>& values, const std::vector<Between>& near, double middle) {
  Span span{middle, middle};
  for (const Between& point : near) {
    const double value =
        values[point.first] + point.share * (values[point.next] - values[point.first]);
    span.low = std::min(span.low, value);
    span.high = std::max(span.high, value);
  }
  return span;
}

// How far a model's values may be off because the angles of a curve are rounded.
ResultTable changes_within(double rounding_deg, const ResultTable& result,
                           const std::vector<double>& theta_deg, const ResultTable& curve,
                           const ResultAt& result_at) {
  ResultTable changes = curve;
  changes.values.assign(curve.values.size(), 0);
  if (rounding_deg <= 0) return changes;
  for (const double by : {-rounding_deg, rounding_deg}) {
    std::vector<double> moved = theta_deg;
    for (double& angle : moved) angle += by;
    const ResultTable there = result_at(moved);
    for (std::size_t c = 0; c < changes.columns(); ++c) {
      const std::size_t column = there.find(changes.channels[c].name);
      if (column == there.columns()) continue;
      for (std::size_t row = 0; row < changes.rows(); ++row) {
        double& change = changes.values[row * changes.columns() + c];
        const double found = std::abs(there.at(row, column) - result.at(row, column));
        if (is_computed(found)) change = std::max(change, found);
      }
    }
  }
  return changes;
}

}  // namespace

std::vector<double> resampling_errors(const std::vector<double>& theta,
                                      const std::vector<double>& values) {
  std::vector<double> errors = largest_nearby(misses(theta, values));
  for (double& error : errors) error *= 3;
  return errors;
}

std::size_t interval_of(const std::vector<double>& theta, double angle) {
  const auto above = std::upper_bound(theta.begin(), theta.end(), angle);
  return above == theta.begin() ? theta.size() - 1
                                : static_cast<std::size_t>(above - theta.begin()) - 1;
}

double step_after(const std::vector<double>& theta, std::size_t i) {
  return i + 1 < theta.size() ? theta[i + 1] - theta[i] : theta.front() + 360 - theta.back();
}

void require_no_wide_gap(const ReferenceCurve& curve) {
  const std::vector<double>& theta = curve.table.theta_deg;
  for (std::size_t i = 0; i < theta.size(); ++i)
    if (const double gap = step_after(theta, i); gap > kLargestGap)
      throw InputError(curve.file.string() + ": has no points between " + number_text(theta[i]) +
                       " and " + number_text(theta[i] + gap) +
                       " deg (shaft angle): must cover the turn with gaps of at most " +
                       number_text(kLargestGap) + " deg");
}

bool covers(const ReferenceCurve& curve, const std::vector<double>& theta_deg) {
  return std::all_of(theta_deg.begin(), theta_deg.end(), [&](double angle) {
    return find_angle(curve.table.theta_deg, reduced(angle), kSameAngle) <
           curve.table.theta_deg.size();
  });
}

Resampled resample(const ReferenceDescription& description, const ReferenceCurve& curve,
                   const std::vector<double>& theta_deg) {
  Resampled out;
  ResultTable& table = out.middle;
  table.name = "reference";
  table.channels = curve.table.channels;
  table.theta_deg = theta_deg;
  table.values.assign(table.rows() * table.columns(), not_computed());
  const auto& theta = curve.table.theta_deg;
  std::vector<std::size_t> at;
  std::vector<std::vector<Between>> near;
  for (const double angle : theta_deg)
    at.push_back(find_angle(theta, reduced(angle), std::max(kSameAngle, curve.angle_rounding_deg)));
  out.exact = std::all_of(at.begin(), at.end(), [&](std::size_t i) { return i < theta.size(); });
  const bool tube = description.tube_deg > 0;
  if (!out.exact || tube) require_no_wide_gap(curve);
  if (tube)
    for (const double angle : theta_deg)
      near.push_back(points_near(theta, reduced(angle), description.tube_deg));
  out.low = out.high = out.uncertainty = table;
  for (std::size_t column = 0; column < table.columns(); ++column) {
    const std::vector<double> values = column_of(curve.table, column);
    const auto known = std::count_if(values.begin(), values.end(), is_computed);
    if (known == 0) continue;
    const bool gaps = known < static_cast<std::ptrdiff_t>(values.size());
    const double rounding = curve.angle_rounding_deg;
    if (gaps && (!out.exact || tube || rounding > 0))
      throw InputError(curve.file.string() + ": column of " + table.channels[column].name +
                       " has empty fields and cannot be resampled");
    std::optional<PeriodicSpline> spline;
    std::vector<double> errors;
    if (!out.exact || rounding > 0) {
      spline.emplace(theta, values);
      errors = resampling_errors(theta, values);
    }
    const double peak = curve.table.peak(table.channels[column].group);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::size_t index = row * table.columns() + column;
      const bool there = at[row] < theta.size();
      table.values[index] = there ? values[at[row]] : (*spline)(theta_deg[row]);
      double& uncertainty = out.uncertainty.values[index] = 0;
      if (!there) uncertainty = errors[interval_of(theta, reduced(theta_deg[row]))];
      if (rounding > 0)
        for (const double by : {-rounding, rounding})
          uncertainty += std::abs((*spline)(theta_deg[row] + by) - (*spline)(theta_deg[row])) / 2;
      if (peak > 0) out.error = std::max(out.error, uncertainty / peak);
      if (!tube) continue;
      const Span span = span_of(values, near[row], table.values[index]);
      out.low.values[index] = span.low;
      out.high.values[index] = span.high;
    }
  }
  return out;
}

Resampled at_own_angles(const ReferenceDescription& description, const ReferenceCurve& curve,
                        const ResultTable& result, const ResultAt& result_at) {
  Resampled out;
  const std::vector<double>& theta = curve.table.theta_deg;
  out.middle = curve.table;
  out.middle.name = "reference";
  out.middle.theta_deg = result.theta_deg;
  out.low = out.high = out.middle;
  out.uncertainty = changes_within(curve.angle_rounding_deg, result, theta, out.middle, result_at);
  if (description.tube_deg <= 0) return out;
  std::vector<std::vector<Between>> near;
  for (const double angle : theta) near.push_back(points_near(theta, angle, description.tube_deg));
  for (std::size_t column = 0; column < out.middle.columns(); ++column) {
    const std::vector<double> values = column_of(curve.table, column);
    const auto known = std::count_if(values.begin(), values.end(), is_computed);
    if (known > 0 && known < static_cast<std::ptrdiff_t>(values.size()))
      throw InputError(curve.file.string() + ": column of " + out.middle.channels[column].name +
                       " has empty fields: there is no tube_deg around them");
    if (known == 0) continue;
    for (std::size_t row = 0; row < theta.size(); ++row) {
      const Span span = span_of(values, near[row], values[row]);
      out.low.values[row * out.low.columns() + column] = span.low;
      out.high.values[row * out.high.columns() + column] = span.high;
    }
  }
  return out;
}

}  // namespace bentaxis::compare

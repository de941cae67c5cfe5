#include "bentaxis/results/body_loads.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace {

using Vector = std::array<double, 3>;

void add(Vector& sum, const Vector& v) {
  for (std::size_t i = 0; i < 3; ++i) sum[i] += v[i];
}
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

// NaN stays NaN: a load that was not found leaves no sum.
double over(double part, double sum) { return sum == 0 ? 0 : part / sum; }
bool beyond(double value, double worst) { return value > worst || std::isnan(value); }

}  // namespace

bool same_load(const BodyLoad& a, const BodyLoad& b) {
  return a.on == b.on && a.by == b.by && a.symbol == b.symbol && a.point == b.point &&
         a.kind == b.kind;
}

std::vector<BodyLoad> BodyLoadTable::row(std::size_t row) const {
  std::vector<BodyLoad> result = loads;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Row& there = at(row, i);
    result[i].at = there.at;
    result[i].force = there.force;
    result[i].moment = there.moment;
  }
  return result;
}

std::vector<BodySum> sums_of(const std::vector<BodyLoad>& loads) {
  struct Scale {
    Vector about;
    double force = 0, moment = 0;
  };
  std::vector<BodySum> sums;
  std::vector<Scale> scales;
  for (const BodyLoad& load : loads) {
    auto sum = std::find_if(sums.begin(), sums.end(),
                            [&](const BodySum& known) { return known.body == load.on; });
    if (sum == sums.end()) {
      sums.push_back({load.on});
      scales.push_back({load.at});
      sum = sums.end() - 1;
    }
    Scale& scale = scales[static_cast<std::size_t>(sum - sums.begin())];
    const Vector lever = minus(load.at, scale.about);
    add(sum->force, load.force);
    add(sum->moment, load.moment);
    add(sum->moment, cross(lever, load.force));
    scale.force += norm(load.force);
    scale.moment += norm(load.moment) + norm(lever) * norm(load.force);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i].force_over_sum = over(norm(sums[i].force), scales[i].force);
    sums[i].moment_over_sum = over(norm(sums[i].moment), scales[i].moment);
  }
  return sums;
}

namespace {

void keep_worst(const std::vector<BodySum>& sums, std::vector<BodySum>& worst) {
  if (worst.empty()) worst = sums;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (beyond(sums[i].force_over_sum, worst[i].force_over_sum)) {
      worst[i].force_over_sum = sums[i].force_over_sum;
      worst[i].force = sums[i].force;
    }
    if (beyond(sums[i].moment_over_sum, worst[i].moment_over_sum)) {
      worst[i].moment_over_sum = sums[i].moment_over_sum;
      worst[i].moment = sums[i].moment;
    }
  }
}

}  // namespace

std::vector<BodySum> worst_sums(const BodyLoadTable& table) {
  if (table.appended > 0) return table.worst;
  std::vector<BodySum> worst;
  for (std::size_t row = 0; row < table.rows(); ++row) keep_worst(sums_of(table.row(row)), worst);
  return worst;
}

void BodyLoadTable::append(const std::vector<BodyLoad>& row) {
  if (loads.empty()) loads = row;
  if (!std::equal(row.begin(), row.end(), loads.begin(), loads.end(), same_load))
    throw ComputationError("loads on bodies: row " + std::to_string(appended + 1) +
                           " has other loads than the first one");
  keep_worst(sums_of(row), worst);
  if (appended++ % step != 0) return;
  for (const BodyLoad& load : row) values.push_back({load.at, load.force, load.moment});
}

}  // namespace bentaxis

#include "bentaxis/analytic/derived.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "bentaxis/numerics/minimum.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic {

DerivedQuantities derived_quantities(const Geometry& g) {
  // With u = cos(theta): z_B = p u + sqrt(q(u)) + const, q(u) = c0 + c1 u + c2 u^2.
  const double difference = g.bore_circle_radius - g.joint_circle_radius;
  const double projected = g.bore_circle_radius - g.joint_circle_radius * std::cos(g.tilt);
  const double offset = g.axis_offset * std::sin(g.tilt);
  const double p = g.joint_circle_radius * std::sin(g.tilt);
  const double c2 = difference * difference - projected * projected;
  const double c1 = 2 * projected * offset;
  const double c0 = g.piston_length * g.piston_length - difference * difference - offset * offset;
  const auto q = [&](double u) { return c0 + u * (c1 + u * c2); };

  // z_B' = 0 squared: 4 p^2 q = q'^2. A root that squaring added is no extremum, so it is harmless.
  std::vector<double> candidates = {-1, 1};
  const auto consider = [&](double u) {
    if (u > -1 && u < 1) candidates.push_back(u);
  };
  const double a = 4 * c2 * (p * p - c2);
  const double half_b = 2 * c1 * (p * p - c2);
  const double c = 4 * p * p * c0 - c1 * c1;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant >= 0) {
    const double root = -half_b - std::copysign(std::sqrt(discriminant), half_b);
    if (a != 0) consider(root / a);
    if (root != 0) consider(c / root);
  }
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double u : candidates) {
    const double z = p * u + std::sqrt(std::max(0.0, q(u)));
    low = std::min(low, z);
    high = std::max(high, z);
  }

  DerivedQuantities result;
  result.stroke = high - low;
  result.piston_area = kPi / 4 * g.bore_diameter * g.bore_diameter;
  result.displacement = g.pistons * result.piston_area * result.stroke;

  // The tilt of a piston follows from q alone; its extremes are at u = -1, 1 or the vertex of q.
  std::vector<double> angles;
  for (const double u : {-1.0, 1.0, c2 != 0 ? std::clamp(-c1 / (2 * c2), -1.0, 1.0) : 1.0}) {
    const double across = g.piston_length * g.piston_length - q(u);
    angles.push_back(
        std::asin(std::clamp(std::sqrt(std::max(0.0, across)) / g.piston_length, 0.0, 1.0)));
  }
  const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
  result.smallest_tilt = *smallest;
  result.largest_tilt = *largest;
  return result;
}

namespace {

// Extremes over a turn of a smooth function of the shaft's angle: those of many angles, each
// refined between its neighbours.
struct Extremes {
  double low, high;
};
template <class Function>
Extremes extremes_of(const Function& value) {
  constexpr int kAngles = 72;
  const double step = 2 * kPi / kAngles;
  Extremes found{value(0.0), value(0.0)};
  double low_at = 0, high_at = 0;
  for (int i = 1; i < kAngles; ++i) {
    const double here = value(i * step);
    if (here < found.low) {
      found.low = here;
      low_at = i * step;
    }
    if (here > found.high) {
      found.high = here;
      high_at = i * step;
    }
  }
  const auto negative = [&](double theta) { return -value(theta); };
  found.low = value(numerics::smallest_at(value, low_at - step, low_at + step));
  found.high = value(numerics::smallest_at(negative, high_at - step, high_at + step));
  return found;
}

}  // namespace

namespace {

// Tilts of pistons that turn the block, which lags by its free play: each piston's own.
void tilt_by_free_play(const PumpParameters& pump, DerivedQuantities& result) {
  const Geometry& g = pump.geometry;
  const Model model(pump, {});
  double nearest = g.piston_length, farthest = 0;
  for (int k = 0; k < g.pistons; ++k) {
    const double phase = 2 * kPi * k / g.pistons;
    const Extremes tilt = extremes_of([&](double theta) {
      const FreePlay play = model.free_play(theta);
      return joint_distance(g, theta - phase, theta - (play.exists ? play.high : 0) - phase);
    });
    nearest = std::min(nearest, tilt.low);
    farthest = std::max(farthest, tilt.high);
  }
  result.smallest_tilt = std::asin(std::min(1.0, nearest / g.piston_length));
  result.largest_tilt = std::asin(std::min(1.0, farthest / g.piston_length));
}

}  // namespace

DerivedQuantities derived_quantities(const PumpParameters& pump) {
  const Geometry& g = pump.geometry;
  if (!pump.transfer.is_uneven_joint()) {
    DerivedQuantities result = derived_quantities(g);
    if (pump.transfer.kind == TransferKind::pistons && pump.transfer.wall)
      tilt_by_free_play(pump, result);
    return result;
  }
  DerivedQuantities result;
  result.piston_area = kPi / 4 * g.bore_diameter * g.bore_diameter;
  double strokes = 0, nearest = g.piston_length, farthest = 0;
  for (int k = 0; k < g.pistons; ++k) {
    const double phase = 2 * kPi * k / g.pistons;
    const auto across = [&](double theta) {
      return joint_distance(g, theta - phase, theta + block_lead(pump, theta) - phase);
    };
    const auto place = [&](double theta) {
      const double off = across(theta);
      return g.joint_circle_radius * std::sin(g.tilt) * std::cos(theta - phase) +
             std::sqrt(std::max(0.0, (g.piston_length - off) * (g.piston_length + off)));
    };
    const Extremes ends = extremes_of(place), tilt = extremes_of(across);
    strokes += ends.high - ends.low;
    nearest = std::min(nearest, tilt.low);
    farthest = std::max(farthest, tilt.high);
  }
  result.stroke = strokes / g.pistons;
  result.displacement = result.piston_area * strokes;
  result.smallest_tilt = std::asin(std::min(1.0, nearest / g.piston_length));
  result.largest_tilt = std::asin(std::min(1.0, farthest / g.piston_length));
  return result;
}

}  // namespace bentaxis::analytic

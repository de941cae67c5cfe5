#include "chamber.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bentaxis/pump/units.h"

namespace bentaxis::hydraulics {

Chamber::Chamber(const Geometry& g, double dead_volume)
    : length_squared_(g.piston_length * g.piston_length),
      joint_across_(g.joint_circle_radius),
      joint_along_(g.joint_circle_radius * std::cos(g.tilt)),
      joint_centre_(g.axis_offset * std::sin(g.tilt)),
      bore_radius_(g.bore_circle_radius),
      area_(kPi / 4 * g.bore_diameter * g.bore_diameter),
      dead_volume_(dead_volume) {
  // In S2 the joint is off the axis of its bore by ((Rd-Ra) sin, (Rd - Ra cos(alpha)) cos - b
  // sin(alpha)).
  rise_ = g.joint_circle_radius * std::sin(g.tilt);
  const double across = g.bore_circle_radius - g.joint_circle_radius;
  const double along = g.bore_circle_radius - g.joint_circle_radius * std::cos(g.tilt);
  const double offset = g.axis_offset * std::sin(g.tilt);
  c0_ = across * across + offset * offset;
  c1_ = -2 * along * offset;
  c2_ = along * along - across * across;

  // Extremes: the ends u = -1, 1 and where rise root = (c1 + 2 c2 u)/2, squared a quadratic.
  std::vector<double> candidates = {-1};  // 1 is where both begin
  const double r2 = rise_ * rise_;
  const double a = c2_ * (c2_ + r2);
  const double b = c1_ * (c2_ + r2);
  const double c = c1_ * c1_ / 4 - r2 * (length_squared_ - c0_);
  const double discriminant = b * b - 4 * a * c;
  if (a != 0 && discriminant >= 0)
    for (const double sign : {-1.0, 1.0})
      candidates.push_back((-b + sign * std::sqrt(discriminant)) / (2 * a));
  else if (a == 0 && b != 0)
    candidates.push_back(-c / b);
  highest_ = lowest_ = height(1).value;
  for (const double u : candidates) {
    if (!(std::abs(u) <= 1)) continue;
    highest_ = std::max(highest_, height(u).value);
    lowest_ = std::min(lowest_, height(u).value);
  }
}

Chamber::Chamber(const Geometry& g, double dead_volume, const StrokeTable& stroke)
    : Chamber(g, dead_volume) {
  if (stroke.theta_deg.empty()) return;
  given_.emplace(stroke.theta_deg, stroke.value);
  const PeriodicSpline::Extremes extremes = given_->extremes();
  lowest_ = extremes.least;
  highest_ = extremes.greatest;
  if (!stroke.is_volume) return;
  area_ = 1;
  dead_volume_ = lowest_;
}

Chamber::Height Chamber::height(double u) const {
  const double root = std::sqrt(length_squared_ - (c0_ + u * (c1_ + u * c2_)));
  return {rise_ * u + root, rise_ - (c1_ + 2 * c2_ * u) / (2 * root)};
}

Chamber::Volume Chamber::volume(double theta) const {
  if (given_) {
    const double angle = theta / kRadPerDegree;
    return {dead_volume_ + area_ * ((*given_)(angle)-lowest_),
            area_ * given_->slope(angle) / kRadPerDegree};
  }
  const Height at = height(std::cos(theta));
  return {dead_volume_ + area_ * (highest_ - at.value), area_ * at.slope * std::sin(theta)};
}

Chamber::Turned Chamber::volume(double theta, double psi) const {
  const double ct = std::cos(theta), st = std::sin(theta);
  const bool locked = psi == theta;
  const double cp = locked ? ct : std::cos(psi), sp = locked ? st : std::sin(psi);
  const double across = bore_radius_ * sp - joint_across_ * st;
  const double along = bore_radius_ * cp - joint_along_ * ct - joint_centre_;
  const double root = std::sqrt(length_squared_ - across * across - along * along);
  return {dead_volume_ + area_ * (highest_ - (rise_ * ct + root)),
          area_ * (rise_ * st + (along * joint_along_ * st - across * joint_across_ * ct) / root),
          area_ * bore_radius_ * (across * cp - along * sp) / root};
}

}  // namespace bentaxis::hydraulics

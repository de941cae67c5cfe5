#include "teeth/flank_curve.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::Vec3;

namespace {

// v turned about z by an angle with this sine and cosine.
Vec3 turned(const Vec3& v, double sine, double cosine) {
  return {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
}

template <class F>
double root(F f, double low, double high) {
  std::uintmax_t most = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      f, low, high, boost::math::tools::eps_tolerance<double>(52), most);
  return (bracket.first + bracket.second) / 2;
}

}  // namespace

double FlankCurve::roll_at(double polar_angle) const {
  constexpr double kStep = 0.05;
  const auto excess = [&](double roll) { return at(roll).polar_angle() - polar_angle; };
  double low = first_roll();
  if (!(excess(low) <= 0)) throw ComputationError("multibody model: a flank begins above its tip");
  double high = low;
  while (excess(high) < 0) {
    low = high;
    high += kStep;
    if (high > 2 * kPi) throw ComputationError("multibody model: a flank does not reach its tip");
  }
  return low == high ? low : root(excess, low, high);
}

SphericalInvolute::SphericalInvolute(double pitch_cone, double pressure_angle) {
  sine_ = std::sin(pitch_cone) * std::cos(pressure_angle);
  cosine_ = std::sqrt((1 - sine_) * (1 + sine_));
  // A point of the great circle has moved out by as much as has rolled off.
  const double rolled = std::acos(std::min(1.0, std::cos(pitch_cone) / cosine_));
  pitch_roll_ = rolled / sine_;
  const Vec3 pitch = at(0).point;
  pitch_azimuth_ = std::atan2(pitch[1], pitch[0]);
}

double SphericalInvolute::base_cone() const { return std::atan2(sine_, cosine_); }

FlankPoint SphericalInvolute::at(double roll) const {
  const double turn = pitch_roll_ + roll;  // of the point of tangency round the base circle
  const double arc = sine_ * turn;         // from there back to the point that draws
  const double s = std::sin(arc), c = std::cos(arc);
  // The great circle, where it touches the base circle at azimuth 0: point of tangency, direction,
  // pole (down the cone).
  const Vec3 touch(sine_, 0, cosine_), along(0, 1, 0), pole(cosine_, 0, -sine_);
  const double azimuth = turn - pitch_azimuth_;
  const double sa = std::sin(azimuth), ca = std::cos(azimuth);
  FlankPoint out;
  out.point = turned(c * touch - s * along, sa, ca);
  // The point turns about the point of tangency.
  out.tangent = turned(pole, sa, ca);
  out.tangent_rate = turned(cosine_ * along, sa, ca);
  out.rate = s * cosine_;
  return out;
}

Octoid::Octoid(double pitch_cone, double pressure_angle)
    : sine_(std::sin(pitch_cone)),
      cosine_(std::cos(pitch_cone)),
      lean_sine_(std::sin(pressure_angle)),
      lean_cosine_(std::cos(pressure_angle)) {
  constexpr double kStep = 0.01;
  double low = 0;
  while (at(low - kStep).rate > 0 && low > -kPi / 2) low -= kStep;
  first_roll_ =
      low <= -kPi / 2 ? low : root([&](double x) { return at(x).rate; }, low - kStep, low);
}

FlankPoint Octoid::at(double roll) const {
  // The pitch planes roll on each other: the crown gear turns by sin(delta) of the gear's angle.
  const double crown = -sine_ * roll;
  const double s = std::sin(crown), c = std::cos(crown);
  // At the pitch point: itself, up the pitch cone and so along the crown gear's axis, round it.
  const Vec3 pitch(sine_, 0, cosine_), up(cosine_, 0, -sine_), round(0, 1, 0);
  // The flank's plane by its normal, which leans by the pressure angle, and how that turns.
  const Vec3 plane = lean_sine_ * up - lean_cosine_ * (c * round - s * pitch);
  const Vec3 plane_rate = lean_cosine_ * (s * round + c * pitch);
  // Foot of the perpendicular from the pitch point, and the direction of the flank there.
  const double off = lean_cosine_ * s;
  const double off_rate = lean_cosine_ * c;
  const double length = std::sqrt((1 - off) * (1 + off));
  const double length_rate = -off * off_rate / length;
  const Vec3 point = (pitch - off * plane) / length;
  const Vec3 point_rate = (-off_rate * plane - off * plane_rate - length_rate * point) / length;
  const Vec3 tangent = (pitch % plane) / length;
  const Vec3 tangent_rate = (pitch % plane_rate - length_rate * tangent) / length;
  // In the gear's frame, which has turned on; by the roll.
  const Vec3 axis(0, 0, 1);
  const double sg = std::sin(roll), cg = std::cos(roll);
  FlankPoint out;
  out.point = turned(point, sg, cg);
  out.tangent = turned(tangent, sg, cg);
  out.tangent_rate = turned(axis % tangent - sine_ * tangent_rate, sg, cg);
  out.rate = SimTK::dot(tangent, axis % point - sine_ * point_rate);
  return out;
}

std::unique_ptr<FlankCurve> flank_curve(FlankShape shape, double pitch_cone,
                                        double pressure_angle) {
  if (shape == FlankShape::octoid) return std::make_unique<Octoid>(pitch_cone, pressure_angle);
  return std::make_unique<SphericalInvolute>(pitch_cone, pressure_angle);
}

}  // namespace bentaxis::multibody

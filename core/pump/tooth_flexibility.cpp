#include "bentaxis/pump/tooth_flexibility.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {

namespace {

using Profile = ToothFlexibility::Profile;

/// A place on the profile: along the tooth's middle from the gear's centre, and half the thickness
/// there.
struct Place {
  double y = 0, x = 0;
  double dy = 0;  // by the curve's parameter
};

/// Angle of the involute's normal to x, the direction of a load there.
double load_angle(const Profile& profile, double roll) { return roll - profile.base_angle; }

Place on_involute(const Profile& profile, double roll) {
  const double angle = load_angle(profile, roll);
  const double r = profile.base_radius;
  return {r * (roll * std::sin(angle) + std::cos(angle)),
          r * (roll * std::cos(angle) - std::sin(angle)), r * roll * std::cos(angle)};
}

/// The envelope of the rack's corner. The normal of what it cuts passes through the pitch point,
/// which the gear has rolled by `way` beyond the corner's centre.
Place on_trochoid(const Profile& profile, double way) {
  const double r = profile.pitch_radius;
  const double angle = (way + profile.corner_offset) / r;
  const double s = std::sin(angle), c = std::cos(angle);
  const double to_centre = std::hypot(way, profile.corner_depth);
  const double stretch = 1 + profile.corner_radius / to_centre;
  const double along = -way * stretch, down = -profile.corner_depth * stretch;
  // By the way: the frame turns by 1/r, the pitch point with it, the distance changes.
  const double d_stretch = -profile.corner_radius * way / (to_centre * to_centre * to_centre);
  const double d_along = -stretch - way * d_stretch;
  const double d_down = -profile.corner_depth * d_stretch;
  return {r * c - along * s + down * c, r * s + along * c + down * s,
          -s - d_along * s - along * c / r + d_down * c - down * s / r};
}

/// Sainsot, Velex and Duverger 2004, table 1: of L, M, P, Q; fitted to half angles of the tooth at
/// the root between these, rad, and to rim ratios from 1.4 to 7. Far below it means nothing.
constexpr double kFittedFrom = 0.01, kFittedTo = 0.12;
constexpr std::array<std::array<double, 6>, 4> kFoundation = {{
    {-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045},
    {60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086},
    {-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236},
    {-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904},
}};

constexpr double kEstimate = 1e-8;

template <typename F>
double integral(const F& f, double from, double to) {
  if (to <= from) return 0;
  // The estimate is the error of the 15 points inside: that of all is far smaller.
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, from, to, 8, kEstimate);
}

Profile cut_by_a_rack(const Gear& gear, double pitch_cone) {
  const ToothData& data = *gear.teeth;
  const double sine = std::sin(gear.pressure_angle), cosine = std::cos(gear.pressure_angle);
  const double tangent = sine / cosine;
  Profile to;
  to.teeth = data.count / std::cos(pitch_cone);
  to.pitch_radius = gear.pitch_diameter / 2 / std::cos(pitch_cone);
  to.base_radius = to.pitch_radius * cosine;
  to.root_radius = to.pitch_radius - data.dedendum;
  to.tip_radius = to.pitch_radius + data.addendum;
  const double half_thickness = kPi * to.pitch_radius / (2 * to.teeth);  // on the pitch circle
  if (data.dedendum <= data.addendum)
    throw InputError("[gear] dedendum_mm: no clearance: must be above addendum_mm");
  const double clearance = data.dedendum - data.addendum;
  const double fits = (half_thickness - data.dedendum * tangent) * cosine / (1 - sine);
  to.corner_radius = std::min(clearance / (1 - sine), fits);
  to.corner_depth = data.dedendum - to.corner_radius;
  const double straight = data.dedendum - to.corner_radius * (1 - sine);
  if (to.corner_radius <= 0 || to.corner_depth <= 0)
    throw InputError(
        "[gear] dedendum_mm: tooth gaps of this depth become pointed above their bottom");
  to.corner_offset = half_thickness + straight * tangent + to.corner_radius * cosine;
  to.base_angle = kPi / (2 * to.teeth) + tangent - gear.pressure_angle;
  to.root_angle = to.corner_offset / to.pitch_radius;
  to.start_roll = tangent - straight / (sine * to.base_radius);
  if (to.start_roll <= 0)
    throw InputError("[gear] dedendum_mm: tooth gaps of this depth undercut the teeth");
  to.tip_roll = std::sqrt(std::pow(to.tip_radius / to.base_radius, 2) - 1);
  if (to.tip_roll - std::atan(to.tip_roll) >= to.base_angle)
    throw InputError("[gear] addendum_mm: teeth of this height become pointed below their tip");
  return to;
}

constexpr int kNodes = 64;

}  // namespace

ToothFlexibility::ToothFlexibility(const Gear& gear, double pitch_cone)
    : profile_(cut_by_a_rack(gear, pitch_cone)),
      youngs_modulus_(gear.teeth->youngs_modulus),
      poisson_ratio_(gear.teeth->poisson_ratio),
      pressure_angle_(gear.pressure_angle),
      rim_ratio_(gear.teeth->rim_ratio),
      coefficients_(kNodes) {
  contact_ = 4 * (1 - poisson_ratio_ * poisson_ratio_) / (kPi * youngs_modulus_);
  const double middle = (profile_.tip_roll + profile_.start_roll) / 2;
  const double half = (profile_.tip_roll - profile_.start_roll) / 2;
  for (int node = 0; node < kNodes; ++node) {
    const double angle = kPi * (node + 0.5) / kNodes;
    const double value = parts_at(middle + half * std::cos(angle)).sum();
    for (int i = 0; i < kNodes; ++i)
      coefficients_[i] += (i == 0 ? 1.0 : 2.0) / kNodes * value * std::cos(i * angle);
  }
  if (!std::isfinite(coefficients_.front()))
    throw InputError("[gear] youngs_modulus_GPa = " + number_text(youngs_modulus_ / 1e9) +
                     ": the flexibility of the teeth is too large");
  // What is rounding only costs time.
  while (std::abs(coefficients_.back()) < 1e-14 * coefficients_.front()) coefficients_.pop_back();
}

double ToothFlexibility::roll(double height) const {
  const double ratio = (profile_.pitch_radius + height) / profile_.base_radius;
  return std::clamp(std::sqrt(std::max(0.0, ratio * ratio - 1)), profile_.start_roll,
                    profile_.tip_roll);
}

double ToothFlexibility::tooth(double height) const {
  const double x = (2 * roll(height) - profile_.start_roll - profile_.tip_roll) /
                   (profile_.tip_roll - profile_.start_roll);
  double before = 0, last = 0;
  for (std::size_t i = coefficients_.size(); i-- > 1;) {
    const double now = 2 * x * last - before + coefficients_[i];
    before = last;
    last = now;
  }
  return x * last - before + coefficients_[0];
}

std::array<double, 4> ToothFlexibility::foundation_factors(double root_angle, double rim_ratio) {
  std::array<double, 4> factors{};
  const double t = std::clamp(root_angle, kFittedFrom, kFittedTo), h = rim_ratio;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const auto& [a, b, c, d, e, f] = kFoundation[i];
    factors[i] = a / (t * t) + b * h * h + c * h / t + d / t + e * h + f;
  }
  return factors;
}

ToothFlexibility::Parts ToothFlexibility::parts(double height) const {
  return parts_at(roll(height));
}

ToothFlexibility::Parts ToothFlexibility::parts_at(double roll) const {
  const Place load = on_involute(profile_, roll);
  const double beta = load_angle(profile_, roll);
  const double c = std::cos(beta), s = std::sin(beta);
  // From the root circle along the trochoid, then along the involute.
  const double trochoid_end = profile_.corner_depth / std::tan(pressure_angle_);
  const auto along_tooth = [&](const auto& f) {
    const auto section = [&f](const Place& at) { return f(at) * at.dy; };
    return integral([&](double way) { return section(on_trochoid(profile_, way)); }, 0.0,
                    trochoid_end) +
           integral([&](double at) { return section(on_involute(profile_, at)); },
                    profile_.start_roll, roll);
  };
  const double shear_modulus = youngs_modulus_ / (2 * (1 + poisson_ratio_));
  const double inverse_area = along_tooth([](const Place& at) { return 1 / (2 * at.x); });
  Parts parts;
  parts.bending = along_tooth([&](const Place& at) {
                    const double lever = c * (load.y - at.y) - s * load.x;
                    return lever * lever / (2.0 / 3 * at.x * at.x * at.x);
                  }) /
                  youngs_modulus_;
  parts.shear = 1.2 * c * c * inverse_area / shear_modulus;
  parts.compression = s * s * inverse_area / youngs_modulus_;
  const auto [l, m, p, q] = foundation_factors(profile_.root_angle, rim_ratio_);
  const double arm = (load.y - load.x * s / c - profile_.root_radius) /
                     (2 * profile_.root_radius * profile_.root_angle);
  parts.foundation =
      c * c / youngs_modulus_ * (l * arm * arm + m * arm + p * (1 + q * s * s / (c * c)));
  return parts;
}

}  // namespace bentaxis

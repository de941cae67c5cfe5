#include "bentaxis/study/ball_bearing.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>

#include "bentaxis/numerics/root.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {
namespace {

using Vector3 = Eigen::Vector3d;

void require(bool holds, const char* what) {
  if (!holds) throw InputError(std::string("ball bearing: ") + what);
}

void check(const BallBearing& b, const BallBearingLoad& load) {
  require(b.balls >= 3, "balls must be 3 or more");
  require(b.ball_diameter > 0 && std::isfinite(b.ball_diameter), "ball_diameter must be > 0");
  require(b.pitch_diameter > b.ball_diameter && std::isfinite(b.pitch_diameter),
          "pitch_diameter must be larger than ball_diameter");
  for (const double ratio : {b.inner_groove_ratio, b.outer_groove_ratio})
    require(ratio > 0.5 && ratio <= 1, "groove ratios must be in (0.5, 1]");
  require(b.radial_clearance >= 0 && b.radial_clearance < 0.1 * b.ball_diameter,
          "radial_clearance must be in [0, ball_diameter / 10)");
  require(b.dynamic_rating > 0 && std::isfinite(b.dynamic_rating), "dynamic_rating must be > 0");
  require(b.youngs_modulus > 0 && std::isfinite(b.youngs_modulus), "youngs_modulus must be > 0");
  require(b.poisson_ratio >= 0 && b.poisson_ratio < 0.5, "poisson_ratio must be in [0, 0.5)");
  for (const double part : {load.radial, load.axial, load.moment, load.first_ball})
    require(std::isfinite(part), "loads must be finite");
  require(load.radial >= 0, "the radial load must be >= 0: it sets the direction phi = 0");
  require(load.radial > 0 || load.axial != 0 || load.moment != 0, "needs a load");
}

// Approach of ball and groove over (load / stiffness of the material)^(2/3), but for a factor that
// both contacts have.
double compliance(double curvature_sum, double curvature_difference) {
  using boost::math::ellint_1;
  using boost::math::ellint_2;
  const auto modulus = [](double ratio) { return std::sqrt(1 - 1 / (ratio * ratio)); };
  const auto apart = [&](double ratio) {
    const double k = modulus(ratio);
    return 1 - 2 / (ratio * ratio - 1) * (ellint_1(k) / ellint_2(k) - 1) - curvature_difference;
  };
  constexpr double kRound = 1.0001, kLong = 1e4;  // half axes of the ellipse of contact
  const double ratio = numerics::root_between(apart, kRound, kLong, apart(kRound), apart(kLong));
  const double k = modulus(ratio);
  return ellint_1(k) * std::cbrt(curvature_sum / (ratio * ratio * ellint_2(k)));
}

class Equilibrium {
 public:
  Equilibrium(const BallBearing& b, const BallBearingLoad& load)
      : b_(b),
        load_(load),
        inner_(b.inner_groove_ratio * b.ball_diameter),
        outer_(b.outer_groove_ratio * b.ball_diameter),
        centres_(inner_ + outer_ - b.ball_diameter),
        start_(centres_ - b.radial_clearance / 2),
        groove_(b.pitch_diameter / 2 + (inner_ - b.ball_diameter / 2) * start_ / centres_) {
    const double g = b.ball_diameter / b.pitch_diameter;
    const auto contact = [&](double ring, double groove) {
      const double sum = 2 + ring - b.ball_diameter / 2 / groove;
      return compliance(2 / b.ball_diameter * sum, (ring + b.ball_diameter / 2 / groove) / sum);
    };
    const double both = contact(g / (1 - g), inner_) + contact(-g / (1 + g), outer_);
    stiffness_ =
        1.48 * b.youngs_modulus / (1 - b.poisson_ratio * b.poisson_ratio) * std::pow(both, -1.5);
  }

  BallBearingState solve() const {
    // Displacements over what a ball gives under the load, so that all are of size 1.
    const double force = std::max(
        {load_.radial, std::abs(load_.axial), std::abs(load_.moment) / (b_.pitch_diameter / 2)});
    const double give = std::pow(5 * force / (b_.balls * stiffness_), 2.0 / 3);
    const double sideways = std::sqrt(std::pow(centres_ + give, 2) - start_ * start_);
    const Vector3 unit(give, sideways, sideways / groove_);
    Vector3 x(load_.radial > 0 ? (b_.radial_clearance / 2 + give) / give : 0,
              load_.axial == 0 ? 0 : std::copysign(1, load_.axial),
              load_.moment == 0 ? 0 : std::copysign(1, load_.moment));
    const auto residual = [&](const Vector3& at) {
      return Vector3(unbalanced(at.cwiseProduct(unit)) / force);
    };
    Vector3 r = residual(x);
    double damping = 1e-3;
    for (int i = 0; i < 1000 && r.norm() > 1e-12; ++i) {
      Eigen::Matrix3d slope;
      for (int j = 0; j < 3; ++j) {
        const Vector3 step = 1e-6 * Vector3::Unit(j);
        slope.col(j) = (residual(x + step) - residual(x - step)) / 2e-6;
      }
      const Eigen::Matrix3d square = slope.transpose() * slope;
      const Vector3 change =
          -(square + damping * (square.diagonal().asDiagonal().toDenseMatrix() +
                                1e-12 * square.trace() * Eigen::Matrix3d::Identity()))
               .ldlt()
               .solve(slope.transpose() * r);
      const Vector3 next = x + change, there = residual(next);
      const bool better = there.allFinite() && there.norm() < r.norm();
      damping = std::clamp(damping * (better ? 0.1 : 10), 1e-15, 1e15);
      if (!better) {
        if (change.norm() < 1e-15 * (1 + x.norm())) break;
        continue;
      }
      x = next;
      r = there;
    }
    if (!(r.norm() < 1e-9)) throw ComputationError("ball bearing: no equilibrium found");
    return state(x.cwiseProduct(unit));
  }

 private:
  double phi(int ball) const { return load_.first_ball + 2 * kPi * ball / b_.balls; }

  // Load of a ball and its contact angle.
  struct Contact {
    double load, angle;
  };
  Contact contact(const Vector3& at, int ball) const {
    const double c = std::cos(phi(ball));
    const double radial = start_ + at[0] * c, axial = at[1] + groove_ * std::sin(at[2]) * c;
    const double give = std::hypot(radial, axial) - centres_;
    return {give > 0 ? stiffness_ * std::pow(give, 1.5) : 0, std::atan2(axial, radial)};
  }

  Vector3 unbalanced(const Vector3& at) const {
    Vector3 sum(-load_.radial, -load_.axial, -load_.moment / (b_.pitch_diameter / 2));
    for (int ball = 0; ball < b_.balls; ++ball) {
      const auto [q, angle] = contact(at, ball);
      const double c = std::cos(phi(ball));
      sum += q * Vector3(std::cos(angle) * c, std::sin(angle), std::sin(angle) * c);
    }
    return sum;
  }

  BallBearingState state(const Vector3& at) const {
    BallBearingState s{at[0], at[1], at[2], {}, 0};
    double cubes = 0, powers = 0;
    for (int ball = 0; ball < b_.balls; ++ball) {
      s.ball_loads.push_back(contact(at, ball).load);
      cubes += std::pow(s.ball_loads.back(), 3) / b_.balls;
      powers += std::pow(s.ball_loads.back(), 10.0 / 3) / b_.balls;
    }
    const double g = b_.ball_diameter / b_.pitch_diameter;
    const double rings = 1.044 * std::pow((1 - g) / (1 + g), 1.72) *
                         std::pow(inner_ / outer_ * (2 * outer_ - b_.ball_diameter) /
                                      (2 * inner_ - b_.ball_diameter),
                                  0.41);
    // Ball loads that each ring carries for a million revolutions.
    const auto rating = [&](double factor, double exponent) {
      return b_.dynamic_rating / (factor * b_.balls) * std::pow(1 + std::pow(rings, exponent), 0.3);
    };
    s.reference_life =
        std::pow(std::pow(rating(0.407, 10.0 / 3) / std::cbrt(cubes), -10.0 / 3) +
                     std::pow(rating(0.389, -10.0 / 3) / std::pow(powers, 0.3), -10.0 / 3),
                 -0.9);
    return s;
  }

  const BallBearing& b_;
  const BallBearingLoad& load_;
  double inner_, outer_;  // groove radii
  double centres_;        // distance of the grooves' centres where a ball just touches both
  double start_;          // their radial distance without displacement
  double groove_;         // radius of the inner groove's centre
  double stiffness_ = 0;  // N/m^1.5, of a ball between both grooves
};

}  // namespace

BallBearingState equilibrium(const BallBearing& bearing, const BallBearingLoad& load) {
  check(bearing, load);
  return Equilibrium(bearing, load).solve();
}

}  // namespace bentaxis::study

// Flexibility of a slice of a tooth: an input that both models share, stated in docs/teeth.md.
#pragma once

#include <array>
#include <vector>

#include "bentaxis/pump/parameters.h"

namespace bentaxis {

/// Flexibility of a slice of a pair of teeth: deflection along the line of action per force per
/// width, m/(N/m). Each tooth is the spur tooth of the equivalent gear (Tredgold: Z / cos delta
/// teeth on the radius (d/2) / cos delta): bending, shear and compression of an involute
/// cantilever, its foundation, and Hertz' flattening of the pair. Slices do not help each other,
/// nor do neighbouring teeth. Shapes shrink towards O2 in proportion, so that flexibility is the
/// same at every distance. Backlash does not make the teeth of this law thinner.
///
/// The tooth is what a rack cuts that rolls off on the pitch circle: straight flanks under the
/// pressure angle, the tip h_f deep with the corners rounded by the largest radius that leaves
/// h_a of straight flank and fits into the rack's tip. So the profile is an involute down to where
/// the mate may touch it, and the rack's trochoid from there to the root circle (the profile of
/// Ma et al. 2014, Engineering Failure Analysis 44).
class ToothFlexibility {
 public:
  /// @param pitch_cone  delta, rad
  /// @throws InputError naming the key where the rack cuts no such tooth
  ToothFlexibility(const Gear& gear, double pitch_cone);

  /// Of one tooth that is loaded at this height over the pitch cone, m, measured at O4.
  /// Smooth; below the involute's start and beyond the tip as there.
  double tooth(double height) const;
  /// Of the flattening of both, wherever they touch: 4 (1 - nu^2) / (pi E).
  double contact() const { return contact_; }

  /// What one tooth's flexibility consists of. With y along the tooth's middle, x(y) half its
  /// thickness, the load at (y_l, x_l) under the angle beta to x, G = E / (2 (1 + nu)) and unit
  /// width, integrated from the root circle to y_l:
  ///   bending      (cos(beta) (y_l - y) - sin(beta) x_l)^2 / (E 2/3 x^3)
  ///   shear        1.2 cos(beta)^2 / (G 2 x)
  ///   compression  sin(beta)^2 / (E 2 x)
  ///   foundation   cos(beta)^2 / E (L (u/s)^2 + M u/s + P (1 + Q tan(beta)^2)), s the tooth's
  ///                thickness along the root circle, u from there to where the load's line meets
  ///                the tooth's middle, L, M, P, Q of s and the rim ratio (Sainsot, Velex and
  ///                Duverger 2004, Journal of Mechanical Design 126; half angles outside of the
  ///                0.01 to 0.12 rad that they fitted have the factors of the nearest of these)
  struct Parts {
    double bending = 0, shear = 0, compression = 0, foundation = 0;
    double sum() const { return bending + shear + compression + foundation; }
  };
  /// By quadrature, which tooth() interpolates: slow.
  Parts parts(double height) const;
  /// L, M, P, Q; `root_angle` is half the tooth's thickness on the root circle, rad.
  static std::array<double, 4> foundation_factors(double root_angle, double rim_ratio);

  /// The equivalent gear's tooth, m and rad.
  struct Profile {
    double teeth = 0;  ///< Z / cos(delta)
    double pitch_radius = 0, base_radius = 0, root_radius = 0, tip_radius = 0;
    double base_angle = 0;     ///< half the thickness on the base circle
    double root_angle = 0;     ///< half the thickness on the root circle
    double start_roll = 0;     ///< tangent of the involute's pressure angle at its start
    double tip_roll = 0;       ///< and at the tip
    double corner_radius = 0;  ///< of the rack's tip
    double corner_depth = 0;   ///< of the corner's centre under the rack's pitch line
    double corner_offset = 0;  ///< of the corner's centre from the middle of the rack's gap
  };
  const Profile& profile() const { return profile_; }

 private:
  double roll(double height) const;
  Parts parts_at(double roll) const;

  Profile profile_;
  double youngs_modulus_ = 0, poisson_ratio_ = 0, pressure_angle_ = 0, rim_ratio_ = 0;
  std::vector<double> coefficients_;  // of Chebyshev polynomials of the roll, start to tip
  double contact_ = 0;
};

}  // namespace bentaxis

// Catalogue data of the shaft's rolling bearings: their life follows from it, no reaction does.
#pragma once

#include <optional>
#include <string>

namespace bentaxis {

/// What rolls: by line contact (life exponent 10/3) or by point contact (load in proportion to the
/// power 3/2 of the deflection, life exponent 3).
enum class RollingElement { roller, ball };

/// Internal geometry of a single-row ball bearing, as catalogues rarely and drawings always give
/// it.
struct BallGeometry {
  int balls = 0;
  double ball_diameter = 0;          ///< Dw, m
  double pitch_diameter = 0;         ///< Dpw, m, of the balls' centres
  double inner_groove_ratio = 0.52;  ///< radius of the inner groove over Dw
  double outer_groove_ratio = 0.53;  ///< radius of the outer groove over Dw
  double radial_clearance = 0;       ///< m, between the rings in operation
};

/// Ratings of a rolling bearing after ISO 281 and ISO 76.
struct BearingRating {
  double dynamic_rating = 0;     ///< C, N
  double static_rating = 0;      ///< C0, N
  std::string designation = {};  ///< in the catalogue, or ""
  RollingElement element = RollingElement::roller;
  std::optional<BallGeometry> balls = {};  ///< where it is known
};

/// Of a single-row tapered roller bearing, or the ball bearing in its place, also how its radial
/// and axial load, Fr and Fa, count together.
struct TaperedRating : BearingRating {
  double axial_factor = 0;         ///< Y
  double ratio_limit = 0;          ///< e: up to Fa / Fr = e the axial load does not count
  double radial_factor = 0;        ///< X, above e
  double static_axial_factor = 0;  ///< Y0
};

/// Each there where the case gives all that has no default.
struct BearingRatings {
  std::optional<TaperedRating> tapered = {};
  std::optional<BearingRating> cylindrical = {};
};

}  // namespace bentaxis

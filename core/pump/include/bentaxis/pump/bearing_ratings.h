// Catalogue data of the shaft's roller bearings: their life follows from it, no reaction does.
#pragma once

#include <optional>
#include <string>

namespace bentaxis {

/// Ratings of a roller bearing after ISO 281 and ISO 76.
struct BearingRating {
  double dynamic_rating = 0;     ///< C, N
  double static_rating = 0;      ///< C0, N
  std::string designation = {};  ///< in the catalogue, or ""
};

/// Of a single-row tapered roller bearing also how its radial and axial load, Fr and Fa, count
/// together.
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

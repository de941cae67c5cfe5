// How far apart two results are: the one measure that every comparison of the program uses.
#pragma once

#include <string>

#include "bentaxis/pump/number.h"

namespace bentaxis::compare {

/// Whether two results have a difference.
enum class Comparable {
  nothing,         ///< nothing was compared
  yes,             ///< they have
  first_missing,   ///< the first result has no value
  second_missing,  ///< the second result has no value
  both_missing,    ///< neither has a value
  not_finite,      ///< a value or the scale is infinite, or the scale is not known
};

/// Whether two values can be compared: both exist and are finite.
Comparable comparable(double first, double second);

/// How far apart two results are, or why that is not known. What is not known is never agreement.
/// As it is made, nothing has been compared.
struct Difference {
  double value = not_computed();  ///< magnitude of the difference, in the results' unit
  double scale = 0;               ///< what it is held to, in the same unit
  Comparable comparable = Comparable::nothing;

  bool known() const { return comparable == Comparable::yes; }
  /// The value over its scale; kOverNoScale where there is a difference but no scale;
  /// not_computed() where it is not known.
  double share() const;
  /// Known, and at most this share of its scale.
  bool within(double limit) const { return share() <= limit; }
  /// Keeps the larger one, by share. A difference that is not known is larger than any other.
  /// @return whether `other` was kept
  bool keep_larger(const Difference& other);
  /// Why it is not known: "the first result has no value"; "" where it is.
  const char* why_unknown() const;
  /// The share in words: "1.2e-13", or "an unknown share (the first result has no value)".
  std::string share_text() const;
};

/// Share of a difference that has nothing to be held to.
inline constexpr double kOverNoScale = 1e300;

/// @param scale  what the difference is held to: at least 0
Difference difference(double first, double second, double scale);

}  // namespace bentaxis::compare

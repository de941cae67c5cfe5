#include "bentaxis/compare/difference.h"

#include <fmt/format.h>

#include <cmath>

namespace bentaxis::compare {

Comparable comparable(double first, double second) {
  if (!is_computed(first) || !is_computed(second))
    return is_computed(second)  ? Comparable::first_missing
           : is_computed(first) ? Comparable::second_missing
                                : Comparable::both_missing;
  return std::isfinite(first) && std::isfinite(second) ? Comparable::yes : Comparable::not_finite;
}

double Difference::share() const {
  if (!known()) return not_computed();
  return scale > 0 ? value / scale : value > 0 ? kOverNoScale : 0;
}

bool Difference::keep_larger(const Difference& other) {
  const bool larger = other.comparable != Comparable::nothing &&
                      (comparable == Comparable::nothing ||
                       (known() && (!other.known() || other.share() > share())));
  if (larger) *this = other;
  return larger;
}

const char* Difference::why_unknown() const {
  switch (comparable) {
    case Comparable::nothing:
      return "nothing was compared";
    case Comparable::first_missing:
      return "the first result has no value";
    case Comparable::second_missing:
      return "the second result has no value";
    case Comparable::both_missing:
      return "neither result has a value";
    case Comparable::not_finite:
      return "a value or its scale is not finite";
    case Comparable::yes:
      break;
  }
  return "";
}

std::string Difference::share_text() const {
  return known() ? fmt::format("{:.1e}", share())
                 : fmt::format("an unknown share ({})", why_unknown());
}

Difference difference(double first, double second, double scale) {
  const Comparable values = comparable(first, second);
  if (values != Comparable::yes) return {not_computed(), scale, values};
  if (!std::isfinite(scale)) return {not_computed(), scale, Comparable::not_finite};
  return {std::abs(second - first), scale, Comparable::yes};
}

}  // namespace bentaxis::compare

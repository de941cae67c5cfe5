// Values that a parameter has in practice, and what may have been meant by others.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/pump/units.h"

namespace bentaxis {

/// A usual slip: the value times `factor` is what may have been meant.
struct Slip {
  double factor;
  const char* words;
};

namespace slips {
inline constexpr Slip kMetres{1000, "in metres?"}, kCentimetres{10, "in centimetres?"},
    kInches{25.4, "in inches?"}, kMicrometres{1e-3, "in micrometres?"},
    kRadius{2, "a radius for a diameter?"}, kDiameter{0.5, "a diameter for a radius?"},
    kSign{-1, "with the other sign?"}, kTenth{0.1, "ten times too large?"},
    kTenfold{10, "ten times too small?"}, kGrams{1e-3, "in grams?"}, kTons{1e3, "in tons?"},
    kRadians{180 / kPi, "in radians?"}, kThousandth{1e-3, "a thousand times too large?"},
    kThousandfold{1e3, "a thousand times too small?"},
    kHundredth{1e-2, "a hundred times too large?"}, kKgM2{1e6, "in kg m2?"},
    kGMm2{1e-3, "in g mm2?"}, kSquareCm{100, "in cm2?"}, kSquareM{1e6, "in m2?"},
    kPascals{1e-5, "in pascals?"}, kKilopascals{1e-2, "in kPa?"};
}  // namespace slips

/// In the file's unit. A value outside is possible, but implausible.
struct PlausibleRange {
  double low = -HUGE_VAL, high = HUGE_VAL;
  std::string why = {};  ///< as the end of a message
  std::vector<Slip> slips = {};
};

}  // namespace bentaxis
